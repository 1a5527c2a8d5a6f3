#include "coordinator/record/contact_measures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace abut {

// ---- SquareIntegral ----------------------------------------

void SquareIntegral::add(double begin, double end, double at_begin, double at_end) {
  const double from = std::max(begin, from_);
  const double to = std::min(end, to_);
  if (!(to > from)) return;
  const double slope = (at_end - at_begin) / (end - begin);
  const double first = at_begin + slope * (from - begin);
  const double last = at_end + slope * (to - end);
  sum_ += 0.5 * (first * first + last * last) * (to - from);
  covered_ += to - from;
  largest_ = std::max({largest_, std::abs(first), std::abs(last)});
}

double SquareIntegral::bare() const {
  const double length = to_ - from_;
  // Thousands of stretches leave rounding between them, whose root would be far above round-off.
  const double rounding = 1e-11 * length;
  return length - covered_ > rounding ? length - covered_ : 0.0;
}

double SquareIntegral::rms(double missing) const {
  return std::sqrt((sum_ + bare() * missing * missing) / (to_ - from_));
}

double SquareIntegral::largest(double missing) const {
  return bare() > 0.0 ? std::max(largest_, std::abs(missing)) : largest_;
}

double SquareIntegral::rms_of_covered() const {
  return covered_ > 0.0 ? std::sqrt(sum_ / covered_) : std::numeric_limits<double>::quiet_NaN();
}

// ---- ContactMeasures ----------------------------------------

ContactMeasures::ContactMeasures(const RunStart& start, int interface, const BarImpact* exact)
    : start_(start),
      index_(interface),
      info_(start.interfaces[interface]),
      exact_(exact),
      readers_{PortReader(start.bodies[info_.body[0]]->ports[info_.port[0]]),
               PortReader(start.bodies[info_.body[1]]->ports[info_.port[1]])},
      gap_min_(std::numeric_limits<double>::infinity()) {
  if (exact == nullptr) return;
  // The jumps of the exact force at both ends of contact cannot be met by any mesh: 5 % are left
  // out there.
  const double from = exact->begin() + 0.05 * exact->duration();
  const double to = exact->begin() + 0.95 * exact->duration();
  force_error_ = SquareIntegral(from, to);
  force_error_tail_ = SquareIntegral(from, exact->end());
  velocity_error_ = SquareIntegral(from, to);
}

std::string ContactMeasures::name(const char* what) const {
  return fmt::format("contact.{}.{}", info_.name, what);
}

void ContactMeasures::on_event(const RunEvent& event) {
  if (event.subject != info_.name) return;
  if (event.kind == RunEvent::Kind::contact_closed) {
    if (count_ == 0) begin_ = event.time;
    ++count_;
    open_ = false;
  } else if (event.kind == RunEvent::Kind::contact_opened) {
    end_ = event.time;
    open_ = true;
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
  if (!mine.closed) return vanish();
  closed_time_ += report.window.length();
  add_closed(*traces[mine.kinematic], mine.kinematic);
}

void ContactMeasures::add_closed(const Waveform& trace, int side) {
  if (trace.f.empty()) return;
  const bool nodal = trace.support == ForceSupport::nodal;
  const PortReader& reader = readers_[side];
  double before = reader.compression(trace, 0);
  if (nodal && !last_.known) follow(trace.time[0], before);
  if (nodal) peak_ = std::max(peak_, before);
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double from = trace.time[i - 1];
    const double to = trace.time[i];
    const double now = reader.compression(trace, i);
    add_force(from, to, nodal ? before : now, now);
    add_velocity(trace, side, i);
    last_step_ = to - from;
    follow(nodal ? to : 0.5 * (from + to), now);
    before = now;
  }
}

void ContactMeasures::add_force(double from, double to, double force_from, double force_to) {
  impulse_ += 0.5 * (force_from + force_to) * (to - from);
  peak_ = std::max(peak_, force_to);
  if (exact_ == nullptr) return;
  const double error_from = force_from / exact_->force() - 1.0;
  const double error_to = force_to / exact_->force() - 1.0;
  force_error_.add(from, to, error_from, error_to);
  force_error_tail_.add(from, to, error_from, error_to);
}

void ContactMeasures::add_velocity(const Waveform& trace, int side, std::size_t i) {
  if (trace.v.empty()) return;
  const double from = readers_[side].along_x(trace, trace.v, i - 1);
  const double to = readers_[side].along_x(trace, trace.v, i);
  velocity_.add(trace.time[i - 1], trace.time[i], from, to);
  if (exact_ == nullptr || exact_->is_wall(side)) return;
  // During contact the exact velocity is constant; its value at the middle is free of the jumps at
  // the ends.
  const double exact = exact_->velocity(side, exact_->begin() + 0.5 * exact_->duration());
  const double scale = exact_->velocity_jump(side);
  velocity_error_.add(trace.time[i - 1], trace.time[i], (from - exact) / scale,
                      (to - exact) / scale);
}

void ContactMeasures::follow(double time, double force) {
  if (exact_ != nullptr && last_.known) {
    const double half = 0.5 * exact_->force();
    if (last_.force >= half && force < half) {
      const double part = (last_.force - half) / (last_.force - force);
      half_force_time_ = last_.time + part * (time - last_.time);
      half_force_seen_ = true;
    }
  }
  last_ = {time, force, true};
}

void ContactMeasures::vanish() {
  if (!last_.known) return;
  follow(last_.time + last_step_, 0.0);
  last_.known = false;
}

void ContactMeasures::write(double run_end, Measures& out) const {
  write_plain(out);
  if (exact_ != nullptr) write_errors(run_end, out);
}

void ContactMeasures::write_plain(Measures& out) const {
  const std::string never = "the interface never closed";
  out.set(name("count"), count_);
  out.set(name("impulse"), impulse_);
  out.set(name("force_peak"), peak_);
  if (std::isfinite(gap_min_)) {
    out.set(name("gap_min"), gap_min_);
  } else {
    out.none(name("gap_min"), "a gap is known between single points in one dimension only");
  }
  if (closed_time_ > 0.0) {
    out.set(name("force_mean"), impulse_ / closed_time_);
    out.set(name("velocity_rms"), velocity_.rms_of_covered());
  } else {
    out.none(name("force_mean"), never);
    out.none(name("velocity_rms"), never);
  }
  if (count_ > 0) {
    out.set(name("begin"), begin_);
  } else {
    out.none(name("begin"), never);
  }
  if (count_ > 0 && open_) {
    out.set(name("end"), end_);
    out.set(name("duration"), end_ - begin_);
  } else {
    const std::string why = count_ > 0 ? "the interface was closed when the run ended" : never;
    out.none(name("end"), why);
    out.none(name("duration"), why);
  }
}

void ContactMeasures::write_errors(double run_end, Measures& out) const {
  const double duration = exact_->duration();
  const std::string never = "the interface never closed";
  const std::string early = "the run ends before the exact contact does";
  if (count_ > 0) {
    out.set(name("begin_error"), (begin_ - exact_->begin()) / duration);
  } else {
    out.none(name("begin_error"), never);
  }
  if (count_ > 0 && open_) {
    out.set(name("release_error"), (end_ - exact_->end()) / duration);
  } else {
    out.none(name("release_error"),
             count_ > 0 ? "the interface was closed when the run ended" : never);
  }
  if (half_force_seen_) {
    out.set(name("release_error_half_force"), (half_force_time_ - exact_->end()) / duration);
  } else {
    out.none(name("release_error_half_force"),
             "the force never fell through half of the exact one");
  }
  const auto put = [this, run_end, &out, &early](const char* what, double end, double value) {
    if (run_end < end) {
      out.none(name(what), early);
    } else if (std::isnan(value)) {
      out.none(name(what), "no substep of the kinematic side lies in the exact contact");
    } else {
      out.set(name(what), value);
    }
  };
  // Without contact there is no force: the error is the whole of the exact one.
  put("force_max_error", force_error_.end(), force_error_.largest(1.0));
  put("force_rms_error", force_error_.end(), force_error_.rms(1.0));
  put("force_rms_error_tail", force_error_tail_.end(), force_error_tail_.rms(1.0));
  put("velocity_rms_error", velocity_error_.end(), velocity_error_.rms_of_covered());
}

}  // namespace abut
