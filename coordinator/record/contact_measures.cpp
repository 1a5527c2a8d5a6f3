#include "coordinator/record/contact_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace abut {

ContactMeasures::ContactMeasures(const RunStart& start, int interface,
                                 std::optional<ContactErrors> errors)
    : start_(start),
      index_(interface),
      info_(start.interfaces[interface]),
      readers_{PortReader(start.bodies[info_.body[0]]->ports[info_.port[0]]),
               PortReader(start.bodies[info_.body[1]]->ports[info_.port[1]])},
      gap_min_(std::numeric_limits<double>::infinity()),
      errors_(std::move(errors)) {}

std::string ContactMeasures::name(const char* what) const {
  return fmt::format("contact.{}.{}", info_.name, what);
}

void ContactMeasures::on_event(const RunEvent& event) {
  if (event.subject != info_.name) return;
  if (event.kind == RunEvent::Kind::contact_closed) {
    if (seen_.count == 0) seen_.begin = event.time;
    ++seen_.count;
    seen_.open = false;
    closed_since_ = event.time;
  } else if (event.kind == RunEvent::Kind::contact_opened) {
    seen_.end = event.time;
    seen_.open = true;
    closed_time_ += event.time - closed_since_;
  }
}

void ContactMeasures::on_window(const WindowReport& report) {
  const Waveform* traces[2];
  for (const int side : {0, 1})
    traces[side] = &report.responses[info_.body[side]].ports[info_.port[side]].trace;
  if (traces[0]->empty() || traces[1]->empty()) return;
  if (readers_[0].port().geometry.dim == 1) {
    for (const BodyRecord& record : report.responses[info_.body[0]].records) {
      const double u0 = readers_[0].at(*traces[0], record.time).u[0];
      const double u1 = readers_[1].at(*traces[1], record.time).u[0];
      gap_min_ = std::min(gap_min_, gap_of(info_, start_, u0, u1));
    }
  }
  const InterfaceReport& mine = report.interfaces[index_];
  if (!mine.closed) {
    if (errors_) errors_->vanish(last_step_);
    return;
  }
  joined_time_ += report.window.length();
  add_closed(*traces[mine.kinematic], mine.kinematic);
}

void ContactMeasures::add_closed(const Waveform& trace, int side) {
  if (trace.f.empty()) return;
  const bool nodal = trace.support == ForceSupport::nodal;
  const PortReader& reader = readers_[side];
  double before = reader.compression(trace, 0);
  if (nodal && errors_ && !errors_->following()) errors_->follow(trace.time[0], before);
  if (nodal) peak_ = std::max(peak_, before);
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double from = trace.time[i - 1];
    const double to = trace.time[i];
    const double now = reader.compression(trace, i);
    add_force(from, to, nodal ? before : now, now);
    add_velocity(trace, side, i);
    last_step_ = to - from;
    if (errors_) errors_->follow(nodal ? to : 0.5 * (from + to), now);
    before = now;
  }
}

void ContactMeasures::add_force(double from, double to, double force_from, double force_to) {
  seen_.impulse += 0.5 * (force_from + force_to) * (to - from);
  peak_ = std::max(peak_, force_to);
  if (errors_) errors_->add_force(from, to, force_from, force_to);
}

void ContactMeasures::add_velocity(const Waveform& trace, int side, std::size_t i) {
  if (trace.v.empty()) return;
  const double from = readers_[side].along_x(trace, trace.v, i - 1);
  const double to = readers_[side].along_x(trace, trace.v, i);
  velocity_.add(trace.time[i - 1], trace.time[i], from, to);
  if (errors_) errors_->add_velocity(side, trace.time[i - 1], trace.time[i], from, to);
}

void ContactMeasures::write(double run_end, Measures& out) const {
  write_plain(run_end, out);
  if (errors_) errors_->write(info_.name, seen_, run_end, out);
}

void ContactMeasures::write_plain(double run_end, Measures& out) const {
  const std::string never = "the interface never closed";
  out.set(name("count"), seen_.count);
  out.set(name("impulse"), seen_.impulse);
  out.set(name("force_peak"), peak_);
  if (std::isfinite(gap_min_)) {
    out.set(name("gap_min"), gap_min_);
  } else {
    out.none(name("gap_min"), "a gap is known between single points in one dimension only");
  }
  const bool at_end = seen_.count > 0 && !seen_.open;
  const double last = at_end ? run_end - closed_since_ : 0.0;
  const double closed = seen_.count > 0 ? closed_time_ + last : joined_time_;
  if (closed > 0.0 && velocity_.covered() > 0.0) {
    out.set(name("force_mean"), seen_.impulse / closed);
    out.set(name("velocity_rms"), std::sqrt(velocity_.sum() / velocity_.covered()));
  } else {
    out.none(name("force_mean"), never);
    out.none(name("velocity_rms"), never);
  }
  if (seen_.count > 0) {
    out.set(name("begin"), seen_.begin);
  } else {
    out.none(name("begin"), never);
  }
  if (seen_.count > 0 && seen_.open) {
    out.set(name("end"), seen_.end);
    out.set(name("duration"), seen_.end - seen_.begin);
  } else {
    const std::string why = seen_.count > 0 ? "the interface was closed when the run ended" : never;
    out.none(name("end"), why);
    out.none(name("duration"), why);
  }
}

}  // namespace abut
