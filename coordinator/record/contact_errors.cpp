#include "coordinator/record/contact_errors.hpp"
#include "coordinator/record/pushes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace abut {

namespace {

/// Contacts of the exact solution, by the same rule.
int count_of(const RowContact& contact, double together) {
  Pushes pushes(together);
  for (const RowContact::Stretch& s : contact.stretches)
    pushes.add(s.begin, s.end, s.force, s.force);
  return pushes.count();
}

}  // namespace

ContactErrors::ContactErrors(const BarRow& row, const RowContact& exact) : exact_(exact) {
  if (!exact.ever()) return;
  for (const std::size_t side : {0u, 1u})
    velocity_jump_[side] = exact.force_peak() * row.mobility(exact.ends[side]);
  double before = exact.begin();
  for (const RowContact::Stretch& s : exact.stretches) {
    // No mesh can meet the jumps at both ends: 5 % are left out there.
    const double margin = 0.05 * (s.end - s.begin);
    const double apart = 0.05 * (s.begin - before);
    force_.expect(before + apart, s.begin - apart, 0.0);
    force_tail_.expect(before + apart, s.begin, 0.0);
    force_.expect(s.begin + margin, s.end - margin, s.force);
    force_tail_.expect(s.begin + margin, s.end, s.force);
    velocity_.expect(s.begin + margin, s.end - margin, s.velocity);
    before = s.end;
  }
}

void ContactErrors::add_force(double from, double to, double force_from, double force_to) {
  if (!exact_.ever()) return;
  force_.add(from, to, force_from, force_to, exact_.force_peak());
  force_tail_.add(from, to, force_from, force_to, exact_.force_peak());
}

void ContactErrors::add_velocity(int side, double from, double to, double v_from, double v_to) {
  const double jump = velocity_jump_[side];
  if (jump > 0.0) velocity_.add(from, to, v_from, v_to, jump);
}

void ContactErrors::follow(double time, double force) {
  if (!exact_.ever()) return;
  if (last_.known) {
    const double step = time - last_.time;
    if (step <= 0.0) return;
    const double half = 0.5 * exact_.stretches.back().force;
    if (last_.force >= half && force < half) {
      // In free flight bodies tell their records alone: the force is gone within a substep.
      const double gone = force == 0.0 && step_ > 0.0 ? std::min(step, step_) : step;
      half_force_time_ = last_.time + (last_.force - half) / (last_.force - force) * gone;
      half_force_seen_ = true;
    }
    step_ = step;
  }
  last_ = {time, force, true};
}

void ContactErrors::write(const std::string& interface, const SeenContact& seen, double run_end,
                          Measures& out) const {
  const std::string prefix = fmt::format("contact.{}.", interface);
  if (!exact_.ever()) {
    for (const std::string what : contact_errors)
      if (what != "count_error") out.none(prefix + what, "the exact solution has no contact here");
    out.set(prefix + "count_error", seen.count);
    return;
  }
  write_times(prefix, seen, out);
  const auto put = [run_end, &prefix, &out](const char* what, double end, double value) {
    if (run_end < end) {
      out.none(prefix + what, "the run ends before the exact contact does");
    } else if (std::isnan(value)) {
      out.none(prefix + what, "no substep of the kinematic side lies in the exact contact");
    } else {
      out.set(prefix + what, value);
    }
  };
  const double peak = exact_.force_peak();
  // Without contact there is no force: the error is the whole of the exact one.
  put("force_max_error", force_.end(), force_.largest(peak));
  put("force_rms_error", force_.end(), force_.rms(peak));
  put("force_rms_error_tail", force_tail_.end(), force_tail_.rms(peak));
  put("velocity_rms_error", velocity_.end(), velocity_.rms_of_covered());
  put("count_error", exact_.end(), seen.count - count_of(exact_, seen.together));
  put("impulse_error", exact_.end(), seen.impulse / exact_.impulse() - 1.0);
}

void ContactErrors::write_times(const std::string& prefix, const SeenContact& seen,
                                Measures& out) const {
  const double duration = exact_.duration();
  const std::string closed = "the interface was closed when the run ended";
  const std::string never = "the interface never closed";
  if (seen.count > 0) {
    out.set(prefix + "begin_error", (seen.begin - exact_.begin()) / duration);
  } else {
    out.none(prefix + "begin_error", never);
  }
  if (exact_.pressed_at_end) {
    out.none(prefix + "release_error", "the exact contact goes on when the run ends");
  } else if (seen.count > 0 && seen.open) {
    out.set(prefix + "release_error", (seen.end - exact_.end()) / duration);
  } else {
    out.none(prefix + "release_error", seen.count > 0 ? closed : never);
  }
  if (half_force_seen_ && !exact_.pressed_at_end) {
    out.set(prefix + "release_error_half_force", (half_force_time_ - exact_.end()) / duration);
  } else {
    out.none(prefix + "release_error_half_force",
             "the force never fell through half of the exact one");
  }
}

void ContactErrors::state(Archive& archive) {
  force_.state(archive);
  force_tail_.state(archive);
  velocity_.state(archive);
  archive.field("time", last_.time);
  archive.field("force", last_.force);
  archive.field("known", last_.known);
  archive.field("step", step_);
  archive.field("half_force_time", half_force_time_);
  archive.field("half_force_seen", half_force_seen_);
}

}  // namespace abut
