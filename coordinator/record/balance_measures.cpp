#include "coordinator/record/balance_measures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/archive_lists.hpp"
#include "coordinator/record/port_reader.hpp"

namespace abut {
namespace {

/// Part of the largest energy below which an energy of the begin is as good as none.
constexpr double as_none = 1.0e-2;

/// [J] that errors are relative to. A run that begins with nothing is measured by what it comes to.
double scale_of(double begin, double peak) {
  if (begin > as_none * peak) return begin;
  return peak > 0.0 ? peak : 1.0;
}

/// [J] that a body has or has turned into heat.
double held_energy(const Energy& energy) { return energy.total() + energy.dissipated; }
/// Without what was done on it: stays, whatever loads and material do.
double own_energy(const Energy& energy) { return held_energy(energy) - energy.external_work; }

/// About the axes of space; zero where a body tells none.
std::array<double, 3> angular_momentum(const BodyRecord& record) {
  const std::vector<double>& told = record.angular_momentum;
  std::array<double, 3> out{};
  std::copy(told.begin(), told.end(), out.end() - static_cast<std::ptrdiff_t>(told.size()));
  return out;
}

constexpr const char* untold_angular = "a body of another program does not tell it";

double length(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

BalanceMeasures::BalanceMeasures(const RunStart& start, const ClosedForm* exact)
    : start_(start),
      exact_(exact),
      recorded_(recorded_bodies(start.bodies)),
      bodies_(recorded_.size()) {
  for (const Description* body : start.bodies) {
    immovable_ = immovable_ || std::isinf(body->mass);
    for (const Port& port : body->ports) round_ = round_ || port.geometry.round;
  }
  if (exact == nullptr) return;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int bar = exact->bar_index(recorded_[b].name);
    if (bar < 0 || exact->row.bar(bar).wall) continue;
    bodies_[b].bar = bar;
    // The largest: a bar may be at rest before its impact or after it.
    bodies_[b].reference = exact->row.total_peak(bar);
  }
}

void BalanceMeasures::begin(const WindowReport& report) {
  begun_ = true;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RecordedBody& recorded = recorded_[b];
    const BodyRecord& record = report.responses[recorded.body].records.front();
    const std::vector<double>& momentum = recorded.momentum(record);
    bodies_[b].first = own_energy(recorded.energy(record));
    for (std::size_t k = 0; k < momentum.size(); ++k) momentum_first_[k] += momentum[k];
    if (recorded.member > 0) continue;  // angular momentum is told of whole bodies
    const Vector angular = angular_momentum(record);
    for (std::size_t k = 0; k < 3; ++k) angular_first_[k] += angular[k];
  }
  total_first_ = total_energy(report, 0);
  for (Body& body : bodies_) {
    if (body.bar >= 0) continue;
    body.reference = body.first != 0.0 ? std::abs(body.first) : std::abs(total_first_);
  }
}

void BalanceMeasures::on_window(const WindowReport& report) {
  if (report.responses.empty() || report.responses.front().records.empty()) return;
  if (!begun_) begin(report);
  follow_exchange(report);
  for (std::size_t r = 0; r < report.responses.front().records.size(); ++r) add(report, r);
}

/// A closed interface carries energy from one body to another, inside a body from member to member.
void BalanceMeasures::follow_exchange(const WindowReport& report) {
  for (std::size_t i = 0; i < report.interfaces.size(); ++i) {
    if (!report.interfaces[i].closed) continue;
    const InterfaceInfo& info = start_.interfaces[i];
    if (!info.many) exchange(info.body, info.port);
  }
  for (const PairReport& pair : report.pairs) exchange(pair.body, pair.port);
}

void BalanceMeasures::exchange(const int (&body)[2], const int (&port)[2]) {
  for (const int side : {0, 1})
    bodies_[recorded_body_of(start_.bodies, body[side], port[side])].exchanged = true;
}

/// Of whole bodies: what acts between the members of one belongs to none of them.
double BalanceMeasures::total_energy(const WindowReport& report, std::size_t record) const {
  double total = 0.0;
  for (const Response& response : report.responses)
    total += own_energy(response.records[record].energy);
  return total;
}

void BalanceMeasures::add(const WindowReport& report, std::size_t record) {
  Vector sum{};
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const BodyRecord& now = report.responses[recorded_[b].body].records[record];
    const Energy& energy = recorded_[b].energy(now);
    const std::vector<double>& momentum = recorded_[b].momentum(now);
    const double expected = body.bar >= 0 ? exact_->row.total(body.bar, now.time) : body.first;
    const double held = body.bar >= 0 ? energy.total() : own_energy(energy);
    body.error = held - expected;
    body.peak = std::max(body.peak, std::abs(held_energy(energy)));
    body.error_max = std::max(body.error_max, std::abs(body.error));
    double square = 0.0;
    for (std::size_t k = 0; k < momentum.size(); ++k) {
      body.momentum[k] = momentum[k];
      if (round_ && k == 0) continue;  // away from the axis on all sides
      sum[k] += momentum[k];
      square += momentum[k] * momentum[k];
    }
    body.momentum_max = std::max(body.momentum_max, std::sqrt(square));
  }
  const double total = total_energy(report, record);
  drift_ = total - total_first_;
  double held = 0.0;
  for (const Response& response : report.responses)
    held += held_energy(response.records[record].energy);
  total_peak_ = std::max(total_peak_, std::abs(held));
  drift_max_ = std::max(drift_max_, std::abs(drift_));
  double square = 0.0;
  for (std::size_t k = round_ ? 1 : 0; k < sum.size(); ++k)
    square += (sum[k] - momentum_first_[k]) * (sum[k] - momentum_first_[k]);
  momentum_change_ = std::max(momentum_change_, std::sqrt(square));
  add_angular(report, record);
}

void BalanceMeasures::add_angular(const WindowReport& report, std::size_t record) {
  Vector change = {-angular_first_[0], -angular_first_[1], -angular_first_[2]};
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (recorded_[b].member > 0) continue;
    Body& body = bodies_[b];
    const BodyRecord& told = report.responses[recorded_[b].body].records[record];
    body.angular = angular_momentum(told);
    body.untold = told.angular_momentum.empty() && !std::isinf(recorded_[b].mass);
    body.angular_max = std::max(body.angular_max, length(body.angular));
    for (std::size_t k = 0; k < 3; ++k) change[k] += body.angular[k];
  }
  angular_change_ = std::max(angular_change_, length(change));
}

void BalanceMeasures::write_angular(Measures& out) const {
  double scale = 0.0;
  bool all_told = true;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    for (int axis = first_rotation_axis(out.scope.dim); axis < 3; ++axis) {
      const std::string name =
          fmt::format("angular_momentum.{}.end{}", recorded_[b].name, axis_ending(3, axis));
      if (bodies_[b].untold) {
        out.none(name, untold_angular);
      } else {
        out.set(name, bodies_[b].angular[axis]);
      }
    }
    scale += bodies_[b].angular_max;
    all_told = all_told && !bodies_[b].untold;
  }
  if (out.scope.dim == 1) return;
  if (round_) {
    out.none("angular_momentum.total", "bodies of revolution have none across their axis");
  } else if (!all_told) {
    out.none("angular_momentum.total", untold_angular);
  } else if (immovable_) {
    out.none("angular_momentum.total", "an immovable body takes momentum and does not keep it");
  } else {
    out.set("angular_momentum.total", scale > 0.0 ? angular_change_ / scale : 0.0);
  }
}

/// Against the exact energy, or against what the body began with and was given by loads. A body
/// that has passed energy on without a closed form has neither: nobody knows what it should hold.
void BalanceMeasures::write_energy(const RecordedBody& recorded, const Body& body,
                                   Measures& out) const {
  const std::string largest = fmt::format("energy.{}.relative_error_max", recorded.name);
  const std::string last = fmt::format("energy.{}.relative_error_end", recorded.name);
  if (body.bar < 0 && body.exchanged) {
    const char* why =
        "the body has exchanged energy through an interface, and no closed form "
        "tells how much it should hold";
    out.none(largest, why);
    out.none(last, why);
    return;
  }
  const double scale = scale_of(body.reference, body.peak);
  out.energy_scales[recorded.name] = scale;
  out.set(largest, body.error_max / scale);
  out.set(last, body.error / scale);
}

void BalanceMeasures::write(Measures& out) const {
  double scale = 0.0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RecordedBody& recorded = recorded_[b];
    const Body& body = bodies_[b];
    write_energy(recorded, body, out);
    for (int axis = 0; axis < out.scope.dim; ++axis) {
      const char* ending = axis_ending(out.scope.dim, axis);
      out.set(fmt::format("momentum.{}.end{}", recorded.name, ending), body.momentum[axis]);
      out.set(fmt::format("mean_velocity.{}.end{}", recorded.name, ending),
              body.momentum[axis] / recorded.mass);
    }
    scale += body.momentum_max;
  }
  out.set("energy.total.begin", total_first_);
  const double energy = scale_of(std::abs(total_first_), total_peak_);
  out.total_energy_scale = energy;
  out.set("energy.total.relative_drift_max", drift_max_ / energy);
  out.set("energy.total.relative_drift_end", drift_ / energy);
  if (immovable_) {
    out.none("momentum.total", "an immovable body takes momentum and does not keep it");
  } else {
    out.set("momentum.total", scale > 0.0 ? momentum_change_ / scale : 0.0);
  }
  write_angular(out);
}

void BalanceMeasures::state(Archive& archive) {
  for (Body& body : bodies_) {
    for (double* value : {&body.first, &body.reference, &body.peak, &body.error, &body.error_max,
                          &body.momentum_max, &body.angular_max})
      archive.field("value", *value);
    field(archive, "momentum", body.momentum);
    field(archive, "angular", body.angular);
    archive.field("exchanged", body.exchanged);
    archive.field("untold", body.untold);
  }
  archive.field("begun", begun_);
  for (double* value :
       {&total_first_, &total_peak_, &drift_, &drift_max_, &momentum_change_, &angular_change_})
    archive.field("value", *value);
  field(archive, "momentum", momentum_first_);
  field(archive, "angular", angular_first_);
}

}  // namespace abut
