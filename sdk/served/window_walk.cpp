#include "sdk/served/window_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr double rounding_of_substep = 1.0e-6;  // of a step: less than this is no step of its own
constexpr double largest_way = 1.0e150;         // whose square is still a number

}  // namespace

WindowWalk::WindowWalk(UserBody& body, const Advance& asked, const std::function<void()>& alive)
    : body_(body), asked_(asked), alive_(alive), force_(body.values(), 0.0) {
  const double length = asked.window.length(), nominal = body.told().substep;
  if (!(length > 0.0)) return;
  const double count = nominal > 0.0 ? length / asked.records / nominal : 1.0;
  each_ = std::max(1, static_cast<int>(std::ceil(count - rounding_of_substep)));
  steps_ = each_ * asked.records;
  dt_ = length / steps_;
  // To the last bit, so that what was made for it is used again.
  if (std::abs(dt_ - nominal) <= rounding_of_substep * nominal) dt_ = nominal;
}

double WindowWalk::time(int level) const {
  const TimeWindow& window = asked_.window;
  return level == steps_ ? window.end
                         : window.begin + level * window.length() / std::max(1, steps_);
}

std::span<const double> WindowWalk::of_port(const std::vector<double>& values,
                                            std::size_t port) const {
  return std::span(values).subspan(body_.first(port), body_.width(port));
}

/// The mean of a step, so that impulses are exact; of a body without inertia the force at its end.
void WindowWalk::find_forces(int step) {
  const double from = time(step - 1), to = time(step);
  std::ranges::fill(force_, 0.0);
  for (std::size_t p = 0; p < body_.ports().size(); ++p) {
    const std::size_t dim = index(body_.told().dim);
    for (const Waveform& wave : asked_.boundary[p].forces) {
      if (wave.empty()) continue;
      part_.assign(index(wave.width), 0.0);
      if (body_.told().quasi_static != 0) {
        wave.force_at(to, part_);
      } else {
        wave.impulse(from, to, part_);
        for (double& each : part_) each /= dt_;
      }
      for (std::size_t k = 0; k < part_.size(); ++k) {
        const std::size_t point = wave.points.empty() ? k / dim : index(wave.points[k / dim]);
        force_[body_.first(p) + point * dim + k % dim] += part_[k];
      }
    }
  }
}

std::optional<Failed> WindowWalk::substep(int step, Response& to) {
  find_forces(step);
  if (const char* const why = body_.step(dt_, force_))
    return Failed{Failed::Cause::no_convergence, time(step), why};
  for (const double u : body_.displacement())
    if (!(std::abs(u) < largest_way))
      return Failed{Failed::Cause::non_finite, time(step), "a displacement is no number"};
  for (std::size_t p = 0; p < to.ports.size(); ++p) to.ports[p].work += body_.work()[p];
  go(to);
  alive_();
  return std::nullopt;
}

Outcome WindowWalk::walk(Response& to) {
  to = Response{};
  to.ports.resize(body_.ports().size());
  tell(to, asked_.window.begin);
  for (int record = 1; record <= asked_.records; ++record) {
    sweep(to, record);
    for (int step = (record - 1) * each_ + 1; step <= record * each_; ++step) {
      if (std::optional<Failed> failed = substep(step, to)) return *failed;
      sweep(to, record);
      if (asked_.sampling == Sampling::substeps || step == record * each_) tell(to, time(step));
    }
    const TimeWindow& window = asked_.window;
    to.records.push_back(body_.record(
        record == asked_.records ? window.end
                                 : window.begin + record * window.length() / asked_.records));
  }
  for (PortResponse& port : to.ports) {
    port.speed_bound = body_.speed_bound();
    port.acceleration_bound = body_.acceleration_bound();
  }
  to.steps = steps_;
  return Advanced{};
}

/// The box of a record's part of the window.
void WindowWalk::sweep(Response& to, int record) const {
  const std::size_t dim = index(body_.told().dim);
  for (std::size_t p = 0; p < to.ports.size(); ++p) {
    PortResponse& port = to.ports[p];
    port.lower.resize(index(record) * dim, std::numeric_limits<double>::infinity());
    port.upper.resize(index(record) * dim, -std::numeric_limits<double>::infinity());
    const std::span<const double> u = of_port(body_.displacement(), p);
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double at = body_.ports()[p].geometry.points[k] + u[k];
      double &low = port.lower[(index(record) - 1) * dim + k % dim],
             &high = port.upper[(index(record) - 1) * dim + k % dim];
      low = std::min(low, at);
      high = std::max(high, at);
    }
  }
}

/// The box of velocities from substep to substep.
void WindowWalk::go(Response& to) const {
  const std::size_t dim = index(body_.told().dim);
  for (std::size_t p = 0; p < to.ports.size(); ++p) {
    PortResponse& port = to.ports[p];
    port.slowest.resize(dim, std::numeric_limits<double>::infinity());
    port.fastest.resize(dim, -std::numeric_limits<double>::infinity());
    const std::span<const double> rate = of_port(body_.rate(), p);
    for (std::size_t k = 0; k < rate.size(); ++k) {
      port.slowest[k % dim] = std::min(port.slowest[k % dim], rate[k]);
      port.fastest[k % dim] = std::max(port.fastest[k % dim], rate[k]);
    }
  }
}

/// What is wanted of the motion and the force of all ports, now.
void WindowWalk::tell(Response& to, double time) const {
  static const Want everything;
  const std::size_t dim = index(body_.told().dim);
  for (std::size_t p = 0; p < to.ports.size(); ++p) {
    const Want& want = asked_.want.empty() ? everything : asked_.want[p];
    Waveform& trace = to.ports[p].trace;
    trace.support = body_.support();
    trace.points = want.points;
    trace.width = static_cast<int>(want.points.empty() ? body_.width(p) : want.points.size() * dim);
    trace.time.push_back(time);
    const auto add = [&](bool wanted, const std::vector<double>& from, std::vector<double>& field) {
      if (!wanted) return;
      const std::span<const double> values = of_port(from, p);
      for (std::size_t k = 0; k < index(trace.width); ++k)
        field.push_back(
            values[want.points.empty() ? k : index(want.points[k / dim]) * dim + k % dim]);
    };
    add(want.u, body_.displacement(), trace.u);
    add(want.v, body_.velocity(), trace.v);
    add(want.a, body_.acceleration(), trace.a);
    add(want.f, body_.force(), trace.f);
  }
}

}  // namespace abut
