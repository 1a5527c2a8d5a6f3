#include "coordinator/conformance/body_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <variant>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr int steps_of_a_window = 4;
constexpr double size_of_a_point = 0.01;  // [m] of ports that have no size

bool same_bits(double one, double other) {
  return std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(other);
}

std::string difference(const std::vector<double>& one, const std::vector<double>& other,
                       const std::string& name) {
  if (one.size() != other.size())
    return fmt::format("{} has {} numbers, then {}", name, one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i)
    if (!same_bits(one[i], other[i]))
      return fmt::format("{} [{}] is {:.17g}, then {:.17g}", name, i, one[i], other[i]);
  return "";
}

}  // namespace

BodyTrial::BodyTrial(Subdomain& body, double begin, double length)
    : body_(body),
      now_(begin),
      step_(about().step > 0.0 ? about().step : length),
      length_(about().step > 0.0 ? steps_of_a_window * step_ : length),
      light_(about().ports.size(), -1.0) {}

Response BodyTrial::window(double length, const std::vector<Push>& pushes, int records) {
  Advance request;
  request.window = {index_, now_, now_ + length};
  request.records = records;
  request.boundary.resize(about().ports.size());
  for (const Push& push : pushes) request.boundary[index(push.port)].forces.push_back(push.force);
  Response response;
  const Outcome outcome = body_.advance(request, response);
  if (const Failed* failed = std::get_if<Failed>(&outcome))
    throw BrokenClause(
        fmt::format("fails in a window from {} s to {} s under light forces: {} ({})", now_,
                    now_ + length, failed->detail, to_string(failed->cause)),
        "A body advances from its initial state.");
  now_ += length;
  ++index_;
  return response;
}

void BodyTrial::save() {
  body_.save();
  saved_at_ = now_;
  saved_index_ = index_;
}

void BodyTrial::restore() {
  body_.restore();
  now_ = saved_at_;
  index_ = saved_index_;
}

Response BodyTrial::again(double length, const std::vector<Push>& pushes) {
  restore();
  return window(length, pushes);
}

double size_of_port(const PortGeometry& surface) {
  if (surface.spacing > 0.0) return surface.spacing;
  const std::size_t dim = index(surface.dim);
  double extent = 0.0;
  for (std::size_t axis = 0; axis < dim; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = axis; k < surface.points.size(); k += dim) {
      low = std::min(low, surface.points[k]);
      high = std::max(high, surface.points[k]);
    }
    extent = std::max(extent, high - low);
  }
  return extent > 0.0 ? extent : size_of_a_point;
}

double BodyTrial::light_force(int port) {
  double& known = light_[index(port)];
  if (known < 0.0) known = find_light_force(port);
  return known;
}

double BodyTrial::find_light_force(int port) {
  const Description& body = about();
  const PortGeometry& surface = body.ports[index(port)].geometry;
  const bool mark = surface.dim > 1 && surface.facets.empty();  // nothing can touch it
  if (!body.can.force || std::isinf(body.mass) || mark) return 0.0;
  const double wanted = light_way * size_of_port(surface);
  if (!body.can.kernel)  // as if all mass followed
    return body.mass * wanted / (length_ * length_) / surface.count();
  const std::vector<double> ones(surface.points.size(), 1.0);
  const int count = std::max(1, static_cast<int>(std::lround(length_ / step_)));
  const PortKernel kernel = body_.probe({port, ones, step_, count});
  std::vector<double> moved(ones.size(), 0.0);  // by 1 N for the whole window
  for (std::size_t k = 0; k < kernel.displacement.size(); ++k)
    moved[k % moved.size()] += kernel.displacement[k];
  double most = 0.0;
  for (const double each : moved) most = std::max(most, std::abs(each));
  return most > 0.0 ? wanted / most : 0.0;
}

Push BodyTrial::push(int port, int axis, double length, double force) const {
  const PortGeometry& surface = about().ports[index(port)].geometry;
  std::vector<double> forces(surface.points.size(), 0.0);
  for (std::size_t k = index(axis); k < forces.size(); k += index(surface.dim)) forces[k] = force;
  return push(port, length, forces);
}

Push BodyTrial::push(int port, double length, const std::vector<double>& forces) const {
  Push push{port, Waveform(static_cast<int>(forces.size()))};
  push.force.support = ForceSupport::step;
  push.force.time = {now_, now_ + length};
  push.force.f = forces;
  push.force.f.insert(push.force.f.end(), forces.begin(), forces.end());
  return push;
}

std::string why_no_force(BodyTrial& trial) {
  const Description& body = trial.about();
  if (!body.can.force) return "the body takes no forces";
  if (std::isinf(body.mass)) return "nothing moves the body";
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
    if (trial.light_force(p) > 0.0) return "";
  return not_moved;
}

std::string first_difference(const Response& one, const Response& other, const Description& body) {
  if (one.steps != other.steps)
    return fmt::format("it takes {} substeps, then {}", one.steps, other.steps);
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const PortResponse &a = one.ports[p], &b = other.ports[p];
    const std::string port = fmt::format("port {}: ", body.ports[p].name);
    for (const auto& [name, left, right] : {std::tuple{"time", &a.trace.time, &b.trace.time},
                                            {"u", &a.trace.u, &b.trace.u},
                                            {"v", &a.trace.v, &b.trace.v},
                                            {"a", &a.trace.a, &b.trace.a},
                                            {"f", &a.trace.f, &b.trace.f},
                                            {"lower", &a.lower, &b.lower},
                                            {"upper", &a.upper, &b.upper}})
      if (const std::string said = difference(*left, *right, port + name); !said.empty())
        return said;
    const std::string numbers =
        difference({a.work, a.speed_bound}, {b.work, b.speed_bound}, port + "work or speed_bound");
    if (!numbers.empty()) return numbers;
  }
  for (std::size_t r = 0; r < one.records.size() && r < other.records.size(); ++r) {
    const Energy &a = one.records[r].energy, &b = other.records[r].energy;
    std::string said = difference({a.kinetic, a.stored, a.dissipated, a.external_work},
                                  {b.kinetic, b.stored, b.dissipated, b.external_work}, "energy");
    if (said.empty())
      said = difference(one.records[r].momentum, other.records[r].momentum, "momentum");
    if (!said.empty()) return said;
  }
  return "";
}

}  // namespace abut
