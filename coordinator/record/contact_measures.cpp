#include "coordinator/record/contact_measures.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace abut {

namespace {

const Port& port_of(const RunStart& start, const InterfaceInfo& interface, int side) {
  return start.bodies[interface.body[side]]->ports[interface.port[side]];
}

/// [s] between a release and a touch that belong to one contact: of the port that sees less.
double together(const RunStart& start, const InterfaceInfo& interface) {
  return transits_of_one_contact * std::max(port_of(start, interface, 0).geometry.transit,
                                            port_of(start, interface, 1).geometry.transit);
}

}  // namespace

ContactMeasures::ContactMeasures(const RunStart& start, int interface,
                                 std::optional<ContactErrors> errors,
                                 std::unique_ptr<ForceFilter> filter,
                                 std::optional<double> steady_after)
    : start_(start),
      index_(interface),
      info_(start.interfaces[interface]),
      readers_{PortReader(port_of(start, info_, 0)), PortReader(port_of(start, info_, 1))},
      times_(together(start, info_)),
      pushes_(together(start, info_)),
      velocity_(together(start, info_)),
      gap_min_(std::numeric_limits<double>::infinity()),
      errors_(std::move(errors)),
      filter_(std::move(filter)) {
  if (steady_after) ripple_.emplace(*steady_after);
  if (!info_.tied) return;
  times_.join(start.begin);
  velocity_.join(start.begin);
}

std::string ContactMeasures::name(const char* what) const {
  return fmt::format("contact.{}.{}", info_.name, what);
}

void ContactMeasures::on_event(const RunEvent& event) {
  if (event.subject != info_.name) return;
  const bool closes = event.kind == RunEvent::Kind::contact_closed;
  if (!closes && event.kind != RunEvent::Kind::contact_opened) return;
  closes ? times_.close(event.time) : times_.open(event.time);
  velocity_.change(closes, event.time);
}

void ContactMeasures::on_window(const WindowReport& report) {
  std::array<const Waveform*, 2> traces;
  for (const std::size_t side : {0u, 1u})
    traces[side] = &report.responses[info_.body[side]].ports[info_.port[side]].trace;
  if (traces[0]->empty() || traces[1]->empty()) return;
  if (readers_[0].port().geometry.dim == 1) read_gap(report, traces);
  const InterfaceReport& mine = report.interfaces[index_];
  if (joins_surfaces()) {
    missed_ = std::max(missed_, mine.missed);
    peak_ = std::max(peak_, mine.force);
    return;
  }
  const std::size_t kinematic = index(mine.kinematic);
  velocity_.on_window(readers_, traces, mine.kinematic, mine.closed, errors_ ? &*errors_ : nullptr);
  if (const Waveform* force = force_of(report, kinematic)) {
    read_force(*force, readers_[kinematic]);
    dissipated_ = mine.dissipated;
  } else {
    read_rest(*traces[kinematic]);
  }
}

/// The force of one point is that on its port. A surface may press on several partners at once:
/// what it does to this one is its reaction; null: none.
const Waveform* ContactMeasures::force_of(const WindowReport& report, std::size_t kinematic) const {
  const PortResponse& reply = report.responses[info_.body[kinematic]].ports[info_.port[kinematic]];
  if (readers_[kinematic].port().geometry.dim == 1) return &reply.trace;
  const std::size_t partner = index(info_.partner[kinematic]);
  if (partner >= reply.reactions.size() || reply.reactions[partner].force.empty()) return nullptr;
  return &reply.reactions[partner].force;
}

void ContactMeasures::read_gap(const WindowReport& report,
                               const std::array<const Waveform*, 2>& traces) {
  for (const BodyRecord& record : report.responses[info_.body[0]].records) {
    const double u0 = readers_[0].at(*traces[0], record.time).u[0];
    const double u1 = readers_[1].at(*traces[1], record.time).u[0];
    gap_min_ = std::min(gap_min_, gap_of(info_, start_, u0, u1));
  }
}

/// Of every window: bodies that nothing touches tell no force.
void ContactMeasures::read_force(const Waveform& trace, const PortReader& reader) {
  if (trace.f.empty()) return;
  const bool nodal = trace.support != ForceSupport::step;
  double before = reader.compression(trace, 0);
  if (nodal) {
    peak_ = std::max(peak_, before);
    if (errors_) errors_->follow(trace.time[0], before);
  }
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double from = trace.time[i - 1];
    const double to = trace.time[i];
    const double now =
        taken_back_.sign(trace, readers_[0].port().geometry, readers_[1].port().geometry, i) *
        reader.compression(trace, i);
    if (!nodal) before = now;
    impulse_ += 0.5 * (before + now) * (to - from);
    pushes_.add(from, to, before, now);
    peak_ = std::max(peak_, now);
    if (filter_) filter_->add(from, to, before, now);
    if (ripple_) ripple_->add(from, to, before, now);
    if (errors_) {
      errors_->add_force(from, to, before, now);
      errors_->follow(nodal ? to : 0.5 * (from + to), now);
    }
    before = now;
  }
}

/// A filter remembers, and a force that goes away ripples: both are told of times without force.
void ContactMeasures::read_rest(const Waveform& trace) {
  for (std::size_t i = 1; i < trace.size(); ++i) {
    if (filter_) filter_->add(trace.time[i - 1], trace.time[i], 0.0, 0.0);
    if (ripple_) ripple_->add(trace.time[i - 1], trace.time[i], 0.0, 0.0);
  }
}

void ContactMeasures::write(double run_end, Measures& out) {
  velocity_.finish(errors_ ? &*errors_ : nullptr);
  write_force(times_.closed(run_end), out);
  write_times(out);
  if (std::isfinite(gap_min_)) {
    out.set(name("gap_min"), gap_min_);
  } else {
    out.none(name("gap_min"), "a gap is known between single points in one dimension only");
  }
  if (!errors_) return;
  const SeenContact seen{times_.begin(),   times_.end(), count(),
                         times_.is_open(), impulse_,     together(start_, info_)};
  errors_->write(info_.name, seen, run_end, out);
}

void ContactMeasures::write_force(double closed, Measures& out) {
  out.set(name("force_peak"), peak_);
  if (joins_surfaces()) {
    const std::string both = "joined surfaces press and pull";
    for (const char* what : {"impulse", "force_mean", "velocity_rms"}) out.none(name(what), both);
    out.set(name("jump_max"), missed_);
    out.set(name("dissipated"), 0.0);
    return;
  }
  out.none(name("jump_max"), "its sides are no joined surfaces");
  out.set(name("impulse"), impulse_);
  out.set(name("dissipated"), dissipated_);
  if (filter_) out.set(name("force_peak_filtered"), filter_->peak());
  if (ripple_ && std::isfinite(ripple_->value())) {
    out.set(name("force_ripple"), ripple_->value());
  } else if (ripple_) {
    out.none(name("force_ripple"), "no force was told after output.steady_after");
  }
  const std::string never = "the interface never closed";
  if (closed > 0.0) {
    out.set(name("force_mean"), impulse_ / closed);
  } else {
    out.none(name("force_mean"), never);
  }
  const double velocity = velocity_.rms();
  if (!std::isnan(velocity)) {
    out.set(name("velocity_rms"), velocity);
  } else {
    out.none(name("velocity_rms"), closed > 0.0 ? "the port tells no velocity" : never);
  }
}

/// Ties do not touch, bodies that meet inside tell events alone, and what no event tells of grazed.
int ContactMeasures::count() const {
  const bool told = times_.count() > 0 && pushes_.any() && !info_.tied;
  return told ? pushes_.count() : times_.count();
}

void ContactMeasures::write_times(Measures& out) const {
  const std::string never = "the interface never closed";
  out.set(name("count"), count());
  out.set(name("closings"), times_.closings());
  if (times_.count() > 0) {
    out.set(name("begin"), times_.begin());
  } else {
    out.none(name("begin"), never);
  }
  if (times_.count() > 0 && times_.is_open()) {
    out.set(name("end"), times_.end());
    out.set(name("duration"), times_.end() - times_.begin());
  } else {
    const std::string why =
        times_.count() > 0 ? "the interface was closed when the run ended" : never;
    out.none(name("end"), why);
    out.none(name("duration"), why);
  }
}

void ContactMeasures::state(Archive& archive) {
  times_.state(archive);
  pushes_.state(archive);
  velocity_.state(archive);
  for (double* value : {&missed_, &impulse_, &peak_, &dissipated_, &gap_min_})
    archive.field("value", *value);
  taken_back_.state(archive);
  if (errors_) errors_->state(archive);
  if (filter_) filter_->state(archive);
  if (ripple_) ripple_->state(archive);
}

}  // namespace abut
