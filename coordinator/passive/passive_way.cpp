#include "coordinator/passive/passive_way.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {

/// Of a window at most: no passive step has a limit of stability, which makes explicit ones far
/// shorter than what is to be seen of contact. Plates that chatter, one of them explicit in a
/// hundred steps a window, lose as much in 32 (16 %), and in 16 more (38 %).
constexpr double parts_of_window = 32.0;
constexpr int most_halvings = 14;
/// Steps that must succeed before they are doubled again, fewer where they are very short.
constexpr int steps_to_double = 8, short_level = 6, short_steps_to_double = 3;
constexpr int most_holds = 4;
/// What bodies repay: those that have no more are left out of the next round.
constexpr int rounds_to_repay = 3;
constexpr double most_of_share = 0.99;
/// After a step of bodies without inertia: at most so many more, until what holds them is this
/// share of what held them most in any step; and the same of a step after which they are told not
/// to rest.
constexpr int most_settling_steps = 60;
constexpr double settled = 1.0e-4, nearly_settled = 1.0e-3;
/// Of what may hold a body at the end of a run.
constexpr double hardly_held = 0.5;
/// They are held so loosely that they should go this far, in parts of the farthest step. What
/// drifts along a way on which nothing else holds it would go farther in vain.
constexpr double settling_way = 0.5;
constexpr int loosest = 10;
/// Steps are in vain that leave more than this share of what held. Slender bodies are softer by far
/// than what holds them, so each lets the next one hold four times as loosely, as long as that goes
/// no farther than this part of the shortest edge. Settling ends after so many more in a row.
constexpr double in_vain = 0.9, most_way = 0.5;
constexpr int most_vain_steps = 4;
/// A step after which so much more is out of balance has lost what presses: it is refused where it
/// goes far. Where steps of one looseness were refused, so many less loose ones let it be tried
/// again.
constexpr double worse = 10.0;
constexpr int well_to_loosen = 3;
/// Of a step: ends that are nearer are the same.
constexpr double same_time = 1.0e-9;

}  // namespace

PassiveWay::PassiveWay(std::vector<TouchingPair> pairs, std::optional<std::vector<PassiveTie>> ties,
                       Bodies& bodies, double window)
    : pairs_(std::move(pairs)),
      ties_(std::move(ties)),
      bodies_(bodies),
      hindrance_(find_hindrance()),
      window_(window) {}

PassiveWay::~PassiveWay() = default;

std::string PassiveWay::find_hindrance() const {
  if (pairs_.empty()) return "no surfaces touch";
  if (!ties_) return "bodies that overlap, or that dashpots join, have no passive form";
  for (int b = 0; b < bodies_.count(); ++b)
    if (!bodies_.describe(b).can.passive)
      return fmt::format("body '{}' ({}) has no passive form", bodies_.describe(b).name,
                         bodies_.describe(b).model);
  return {};
}

bool PassiveWay::on_a_line() const {
  return !pairs_.empty() && bodies_.port(pairs_.front().sides[0]).geometry.dim == 1;
}

bool PassiveWay::statics() const {
  for (int b = 0; b < bodies_.count(); ++b) {
    const Description& body = bodies_.describe(b);
    if (std::isfinite(body.mass) && !body.quasi_static) return false;
  }
  return true;
}

void PassiveWay::make() {
  if (step_ != nullptr) return;
  nominal_ = bodies_.shortest_step();
  if (!on_a_line()) nominal_ = std::max(nominal_, window_ / parts_of_window);
  surfaces_ = std::make_unique<TouchingSurfaces>(pairs_, bodies_);
  const double thickness = statics() ? thickness_at_rest : thickness_share;
  near_ = std::make_unique<NearRows>(*surfaces_, thickness * surfaces_->shortest_edge());
  step_ = std::make_unique<CommonStep>(*surfaces_, *near_, *ties_, bodies_, nominal_, statics());
}

std::optional<Failed> PassiveWay::enter(double time, bool unanswered) {
  if (unanswered) ++ledger_.unanswered;
  // Anew each time: a run that was resumed since bodies went so last knows nothing of that.
  step_.reset();
  near_.reset();
  make();
  for (int b = 0; b < bodies_.count(); ++b) {
    const double lost = bodies_.ask_passively(b).enter();
    ledger_.switched += lost;
    if (lost != 0.0) PassiveLedger::add(ledger_.taken, b, lost);
  }
  active_ = true;
  level_ = good_ = held_ = 0;
  farthest_ = 0.0;
  return step_->begin(time);
}

std::optional<Failed> PassiveWay::window(const TimeWindow& window, int records,
                                         std::span<const Joint> joints) {
  std::vector<PassiveRecord::Told> told;
  for (const Joint& joint : joints)
    if (joint.exchange != nullptr && !joint.tied())
      told.push_back({joint.kinematic_side(), joint.neumann_side()});
  PassiveRecord record(*surfaces_, bodies_);
  record.begin(window.begin, *step_, std::move(told));
  quiet_ = true;
  pressed_.clear();
  halved_ = false;
  const std::int64_t rigid = ledger_.rigid;
  double time = window.begin;
  for (int r = 1; r <= records; ++r) {
    const double end =
        r == records ? window.end : window.begin + window.length() * r / double(records);
    if (std::optional<Failed> failed = advance_to(end, time, record)) return failed;
    record.record(*step_);
  }
  record.finish();
  ++ledger_.windows;
  if (halved_) ++ledger_.halved_windows;
  if (ledger_.rigid > rigid) ++ledger_.rigid_windows;
  return std::nullopt;
}

/// Whole parts of the nominal step, halved where a step is refused. With inertia steps become
/// shorter towards a window's end, which what is crushed needs; statics would settle after each.
std::optional<Failed> PassiveWay::advance_to(double end, double& time, PassiveRecord& record) {
  while (time < end) {
    const double left = end - time;
    const int halved = statics() ? level_ : 0;
    const double parts = std::ceil(std::ldexp(left / nominal_, halved) - same_time);
    const double length = left / parts / std::ldexp(1.0, level_ - halved);
    const double next = left - length < same_time * length ? end : time + length;
    if (step(time, next, record, level_ >= most_halvings - 4)) {
      time = next;
      if (++good_ >= (level_ > short_level ? short_steps_to_double : steps_to_double) &&
          level_ > 0) {
        --level_;
        good_ = 0;
        held_ = 0;
      }
      continue;
    }
    good_ = 0;
    if (++level_ <= most_halvings) continue;
    if (hold_rigid()) continue;
    const std::string driven = step_->driven();
    return Failed{Failed::Cause::step_too_small, time,
                  "no passive step was found: " + (driven.empty() ? step_->why() : driven)};
  }
  return std::nullopt;
}

bool PassiveWay::step(double begin, double end, PassiveRecord& record, bool lenient) {
  bodies_.save_all();
  halved_ = halved_ || level_ > 0;
  ++ledger_.steps;
  if (step_->take(begin, end, lenient, ledger_)) {
    bodies_.restore_all();
    ++ledger_.refused;
    if (step_->culprit() >= 0) PassiveLedger::add(ledger_.refused_by, step_->culprit(), 1.0);
    return false;
  }
  if (statics()) settle(begin, end, lenient);
  const double length = end - begin;
  if (ledger_.shortest_step == 0.0 || length < ledger_.shortest_step)
    ledger_.shortest_step = length;
  record.add(*step_, begin, end);
  note_pressed();
  return true;
}

/// Until what held bodies without inertia in a step no longer does: they are held more and more
/// loosely, by what is proportional to how far they go. Where impulses are not found for what is
/// held loosely it is held more.
void PassiveWay::settle(double begin, double end, bool lenient) {
  double left = step_->farthest();  // [m] by which what is out of balance would move a first step
  farthest_ = std::max(farthest_, left);
  const double way = most_way * surfaces_->shortest_edge();
  double least = left;
  int most = loosest, vain = 0, further = 0, well = 0;
  for (int k = 0; k < most_settling_steps && vain < most_vain_steps; ++k) {
    if (left <= settled * farthest_ && step_->held() <= hardly_held) return;
    const double free = std::log2(settling_way * farthest_ / left) / 2.0;
    int looser = static_cast<int>(std::clamp<double>(free, std::min(1, most), most));
    const int before = looser;
    while (looser < std::min(before + further, most) && std::ldexp(left, 2 * looser + 2) < way)
      ++looser;
    bodies_.save_all();
    const double far = std::max({std::ldexp(worse * left, 2 * looser), way, farthest_});
    if (!step_->settle(begin, end, looser, far, lenient, ledger_)) {
      bodies_.restore_all();
      most = looser - 1, well = 0;
      if (most < 0) break;
      continue;
    }
    if (looser == most && most < loosest && ++well == well_to_loosen) ++most, well = 0;
    left = std::ldexp(step_->farthest(), -2 * looser);
    if (left <= in_vain * least)
      vain = 0;
    else if (looser == before + further && looser < most)
      ++further;
    else
      ++vain;
    least = std::min(least, left);
  }
  if (!(least > nearly_settled * farthest_)) return;
  ++ledger_.unsettled;
  ledger_.unbalanced = std::max(ledger_.unbalanced, least / farthest_);
}

/// Which surfaces press on each other.
void PassiveWay::note_pressed() {
  for (const DistanceRow& row : step_->rows()) {
    if (row.normal_impulse <= 0.0) continue;
    quiet_ = false;
    const TouchingSurfaces::Point& one = (*surfaces_)[row.first_point(0)];
    const TouchingSurfaces::Point& other = (*surfaces_)[row.first_point(1)];
    const std::array<int, 4> pair = {one.body, one.port, other.body, other.port};
    if (std::ranges::find(pressed_, pair) == pressed_.end()) pressed_.push_back(pair);
  }
}

bool PassiveWay::pressed(const Joint& joint) const {
  return std::ranges::any_of(pressed_, [&joint](const std::array<int, 4>& pair) {
    const auto& [a, b] = joint.sides;
    return pair == std::array{a.body, a.port, b.body, b.port} ||
           pair == std::array{b.body, b.port, a.body, a.port};
  });
}

double PassiveWay::rubbed(const Joint& joint) const {
  const auto& [a, b] = joint.sides;
  const auto found = ledger_.rubbed.find(PassiveLedger::pair_of(a.body, a.port, b.body, b.port));
  return found == ledger_.rubbed.end() ? 0.0 : found->second;
}

/// Takes all of the deformation's kinetic energy away: what the last rung costs.
bool PassiveWay::hold_rigid() {
  if (++held_ > most_holds) return false;
  ++ledger_.rigid;
  level_ = most_halvings / 2;
  for (int b = 0; b < bodies_.count(); ++b) {
    if (!std::isfinite(bodies_.describe(b).mass)) continue;
    const double taken = bodies_.ask_passively(b).damp(step_->record(b).energy.kinetic);
    ledger_.damped += taken;
    PassiveLedger::add(ledger_.taken, b, taken);
    step_->lower(b, taken);
  }
  return true;
}

std::vector<double> PassiveWay::repay(std::span<const int> bodies, double joules) {
  std::vector<double> gave(bodies.size(), 0.0);
  const auto energy_of = [this](int b) -> Energy& {
    return bodies_.response(b).records.back().energy;
  };
  std::vector<char> gives(bodies.size(), 1);  // what it is asked for
  double left = joules;
  for (int round = 0; round < rounds_to_repay && left > 0.0; ++round) {
    double motion = 0.0;
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (gives[k] != 0) motion += energy_of(bodies[k]).kinetic;
    if (!(motion > 0.0)) break;
    std::vector<double> shares(bodies.size(), 0.0);
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (gives[k] != 0) shares[k] = left * energy_of(bodies[k]).kinetic / motion;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (!(shares[k] > 0.0)) continue;
      const double given = bodies_.ask_passively(bodies[k]).damp(shares[k]);
      gives[k] = given >= most_of_share * shares[k];
      energy_of(bodies[k]).kinetic -= given;
      if (active_) step_->lower(bodies[k], given);
      gave[k] += given;
      left -= given;
    }
  }
  return gave;
}

bool PassiveWay::leave(double time, double may_lose) {
  bodies_.save_all();
  std::vector<double> lost(index(bodies_.count()), 0.0);
  for (int b = 0; b < bodies_.count(); ++b) {
    const Outcome outcome = bodies_.ask_passively(b).leave(time, lost[index(b)]);
    if (std::holds_alternative<Failed>(outcome)) {
      bodies_.restore_all();
      return false;
    }
  }
  if (std::accumulate(lost.begin(), lost.end(), 0.0) > may_lose) {
    bodies_.restore_all();
    return false;
  }
  for (int b = 0; b < bodies_.count(); ++b) {
    ledger_.switched += lost[index(b)];
    if (lost[index(b)] != 0.0) PassiveLedger::add(ledger_.taken, b, lost[index(b)]);
  }
  ledger_.owed = 0.0;  // the accurate way does not know of it
  active_ = false;
  return true;
}

void PassiveWay::rejoin(double lost) {
  ledger_.switched += lost;
  for (const PassiveTie& tie : *ties_)
    if (tie.tie != nullptr) tie.tie->rejoin();
}

void PassiveWay::totals(Archive& archive) {
  if (archive.writing()) were_statics_ = statics();
  whole(archive, "statics", were_statics_);
  earlier_.state(archive);
  ledger_.state(archive);
}

void PassiveWay::begin_stage() {
  earlier_ = of_all_stages();
  if (were_statics_ && !statics()) earlier_.leave_out_energies();
  ledger_ = {};
}

void PassiveWay::state(Archive& archive) {
  whole(archive, "active", active_);
  if (!active_) return;
  make();
  whole(archive, "level", level_);
  whole(archive, "good", good_);
  whole(archive, "held", held_);
  archive.field("farthest", farthest_);
  near_->state(archive);
  step_->state(archive);
}

}  // namespace abut
