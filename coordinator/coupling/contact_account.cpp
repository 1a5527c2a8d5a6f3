#include "coordinator/coupling/contact_account.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace abut {

namespace {

constexpr double account_floor = 1.0e-9;  // of the largest contact force: less is no compression
// Of the fastest first touch: what meets more slowly only grazes, until it presses.
constexpr double grazing_share = 1.0e-2;
// Of the largest contact force of the run: what grazes and presses less only touches. Forerunners
// of a front reach a few per cent.
constexpr double pressing_share = 0.05;
// Of the largest energy of the run: what an event must move for a window to end there.
constexpr double notable_share = 1.0e-6;
// The same: what is owed for it to be paid after an event. Between events only what is notable is
// paid: to pay what the iteration leaves open would disturb more than it mends.
constexpr double payable_share = 1.0e-13;

}  // namespace

void ContactRun::state(Archive& archive) {
  archive.field("fastest_touch", fastest_touch);
  archive.field("force_reference", force_reference);
}

void ContactAccount::state(Archive& archive) {
  archive.field("opened_at", opened_at_);
  archive.field("touched_at", touched_at_);
  archive.field("touch_speed", touch_speed_);
  archive.field("debt", debt_);
  archive.field("rebound_impulse", rebound_impulse_);
}

/// [N] of the window in history_: what the iteration leaves open is no force.
double ContactAccount::least_force(const Joint& joint, const ContactRun& run) const {
  return std::max(account_floor, run.tolerance) *
         std::max(joint.contact.force_scale, history_.peak());
}

std::optional<double> ContactAccount::event(const Joint& joint, double energy,
                                            const ContactRun& run, Bodies& bodies) {
  history_.read(joint, opened_at_, bodies);
  const double floor = least_force(joint, run), notable = notable_share * energy;
  for (std::size_t k = 1; k < history_.size(); ++k) {
    const ContactLevel& before = history_[k - 1];
    const bool gone = before.force > floor && history_[k].force <= floor;
    if (history_.kicks() ? !gone : std::abs(history_.energy(k)) <= notable) continue;
    return history_.kicks() ? before.time : history_[k].time;
  }
  return std::nullopt;
}

bool ContactAccount::release_kick(Joint& joint, const TimeWindow& window, const ContactRun& run,
                                  Bodies& bodies, ContactChanges& changes) {
  history_.read(joint, opened_at_, bodies);
  if (!history_.kicks() || history_.size() < 2) return false;
  const double floor = least_force(joint, run);
  if (history_[0].force <= floor || history_[1].force > floor) return false;
  joint.contact.impulse = std::exchange(rebound_impulse_, 0.0);
  opened_at_ = window.begin;
  if (joint.pressing()) {
    joint.release();
    changes.push_back({false, history_.release(1), 0.0});
  }
  return true;
}

void ContactAccount::settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
                            Bodies& bodies, ContactChanges& changes) {
  history_.read(joint, opened_at_, bodies);
  joint.contact.force_scale = std::max(joint.contact.force_scale, history_.peak());
  run.force_reference = std::max(run.force_reference, history_.peak());
  debt_ -= contact_work(joint, bodies);
  rebound_impulse_ = release_impulse(joint, debt_, bodies);
  joint.contact.impulse = due_impulse(joint, debt_, energy, bodies);
  for (const Side& side : joint.sides) bodies.strike_record(side, joint.contact.impulse);
  see_pushes(joint, run, changes);
  disengage(joint, window, run, bodies);
}

/// [N s] that pays the debt [J] after the window in history_; 0: it waits.
double ContactAccount::due_impulse(const Joint& joint, double debt, double energy,
                                   const Bodies& bodies) const {
  const std::size_t last = history_.size() - 1;
  const bool active = history_[last].force > 0.0 || (last > 0 && history_[last - 1].force > 0.0);
  if (history_.kicks() || !active) return 0.0;  // bodies that are apart give each other nothing
  bool changed = false;
  for (std::size_t k = 1; k <= last && !changed; ++k)
    changed = (history_[k - 1].force > 0.0) != (history_[k].force > 0.0);
  const double least = (changed ? payable_share : notable_share) * energy;
  return std::abs(debt) <= least ? 0.0 : paying_impulse(joint, debt, bodies);
}

double ContactAccount::payment(const Joint& joint, double energy, Bodies& bodies) {
  history_.read(joint, opened_at_, bodies);
  const double debt = debt_ - contact_work(joint, bodies);
  return work_of_impulse(joint, due_impulse(joint, debt, energy, bodies), bodies);
}

double ContactAccount::overpaid(const Joint& joint, double energy, Bodies& bodies) {
  const double paid = payment(joint, energy, bodies);
  return std::max(0.0, paid - (debt_ - contact_work(joint, bodies)));
}

void ContactAccount::settle_passively(Joint& joint, const TimeWindow& window, ContactRun& run,
                                      const Bodies& bodies, ContactChanges& changes) {
  debt_ = rebound_impulse_ = 0.0;
  const Waveform& own = trace_of(bodies, joint.kinematic_side());
  const Waveform& other = trace_of(bodies, joint.neumann_side());
  const double outward = joint.normal_of(joint.role.kinematic);
  const double peak = largest_force(joint, bodies);
  joint.contact.force_scale = std::max(joint.contact.force_scale, peak);
  run.force_reference = std::max(run.force_reference, peak);
  if (!(peak > 0.0)) {
    const double apart = joint.gap(trace_of(bodies, joint.sides[0]).u.back(),
                                   trace_of(bodies, joint.sides[1]).u.back());
    if (apart <= grazing_share * run.fastest_touch * window.length()) return;
    if (joint.pressing()) changes.push_back({false, own.time.front(), 0.0});
    joint.release();
    return;
  }
  if (joint.pressing()) return;
  std::size_t first = 1;  // a force acts over the step that ends at its time
  while (first + 1 < own.size() && -outward * own.f[first] <= 0.0) ++first;
  const double speed = std::max(0.0, outward * (own.v[first - 1] - other.v[first - 1]));
  run.fastest_touch = std::max(run.fastest_touch, speed);
  joint.press();
  joint.contact.closing_speed = std::max(speed, run.still());
  changes.push_back({true, own.time[first - 1], speed});
}

/// Pushes that begin and end in the window.
void ContactAccount::see_pushes(Joint& joint, ContactRun& run, ContactChanges& changes) {
  const double floor = std::max(least_force(joint, run), history_.rounding());
  const double bound = std::max(floor, pressing_share * run.force_reference);
  for (std::size_t k = 1; k < history_.size(); ++k) {
    const ContactLevel& before = history_[k - 1];
    const ContactLevel& now = history_[k];
    if (now.force > floor && before.force <= floor) {
      const Touch touch = history_.touch(k);
      touched_at_ = touch.time;
      touch_speed_ = touch.speed;
      run.fastest_touch = std::max(run.fastest_touch, touch.speed);
    }
    const bool fast = touch_speed_ > grazing_share * run.fastest_touch;
    if (!joint.pressing() && now.force > floor && (fast || now.force > bound)) {
      joint.press();
      const double begin = fast ? touched_at_ : history_.crossing(k, bound);
      joint.contact.closing_speed = std::max(touch_speed_, run.still());
      changes.push_back({true, begin, touch_speed_});
    } else if (joint.pressing() && now.force <= floor) {
      joint.release();
      changes.push_back({false, history_.release(k), 0.0});
    }
  }
}

/// Sides that have parted are free again.
void ContactAccount::disengage(Joint& joint, const TimeWindow& window, const ContactRun& run,
                               const Bodies& bodies) const {
  const double gap = history_[history_.size() - 1].gap;
  const bool apart = gap > grazing_share * run.fastest_touch * window.length();
  if (!apart || largest_force(joint, bodies) > 0.0 || joint.pressing()) return;
  joint.disengage();
}

}  // namespace abut
