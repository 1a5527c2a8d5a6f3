// The way through windows that the iteration cannot take: bodies in their passive forms.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "base/index.hpp"
#include "contract/no_answer.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/velocity_start.hpp"
#include "coordinator/touching_pairs.hpp"

namespace abut {

namespace {

/// Ways that surfaces can come in a window: those that only meet passively do so from there on, and
/// the accurate method takes over where all are farther apart than that.
constexpr double near_ways = 1.5, far_ways = 4.0;
/// Windows: the accurate method that fails sooner is tried again later, at most after so many.
constexpr int soon = 10, longest_wait = 64;
/// Of the largest energy: bodies that would lose more by their own forms stay passive for a while.
constexpr double lost_by_return = 1.0e-3;

constexpr double anything = std::numeric_limits<double>::infinity();

/// [J] of all that is there at the end, and what contact has taken.
double energy_put_in(const Bodies& bodies, const PassiveLedger& ledger) {
  double all = ledger.given_up() + ledger.friction;
  for (const Response& response : bodies.responses()) {
    if (response.records.empty()) continue;
    const Energy& energy = response.records.back().energy;
    all += energy.total() + energy.dissipated;
  }
  return all;
}

}  // namespace

bool Controller::may_go_passively() const {
  return passive_.hindrance().empty() &&
         scene_.schwarz.on_nonconvergence == OnNonconvergence::passive;
}

/// Of a window that has not converged, before it fails: as the scene says, or where statics would
/// go passively, which is right to some hundredths alone, and tells no energies. Bodies without
/// inertia that have no answer have halved the step by themselves.
int Controller::most_halvings() const {
  constexpr int asked_for = 20, of_statics = 4;
  if (scene_.schwarz.on_nonconvergence == OnNonconvergence::halve) return asked_for;
  return may_go_passively() && passive_.statics() && !attempt_.failed ? of_statics : 0;
}

/// Not in statics: what is left of a residual is work there, and shorter windows were tried. Nor
/// for long: what swings from window to window may make energy where little moves.
bool Controller::nearly_converged() const {
  constexpr int most_in_a_row = 5;
  return may_go_passively() && !passive_.statics() && attempt_.nearly() &&
         waiting_.near < most_in_a_row;
}

void Controller::note_near(const TimeWindow& window) {
  waiting_.near = attempt_.converged() ? 0 : waiting_.near + 1;
  if (waiting_.near == 0) return;
  if (passive_.ledger().near_windows == 0)
    narrator_.warning(window.begin, "",
                      attempt_.trouble(scene_.schwarz.tolerance) +
                          "; such windows are accepted, and counted (accuracy.given_up)");
  passive_.count_near(attempt_.missed().largest());
}

/// Schemes of finite strain make energy in steps that are long for a body's waves and turns: what
/// would end the run is gone the other way.
std::optional<Failed> Controller::made_by_themselves(const TimeWindow& window) const {
  const int records = scene_.output.records_per_window;
  if (!may_go_passively() || passive_.on_a_line() ||
      !guard_.refuses_flight(bodies_.responses(), records))
    return std::nullopt;
  return Failed{Failed::Cause::no_convergence, window.end,
                "steps of a body that nothing touches would make energy"};
}

/// What keeps the accurate method from the window ends the run, unless bodies can go passively.
void Controller::try_window(const TimeWindow& window) {
  try {
    advance(window);
  } catch (const NoAnswer& error) {
    if (!may_go_passively()) throw;
    attempt_.failed = Failed{Failed::Cause::no_convergence, window.begin,
                             error.where + ": " + error.what_is_wrong};
  }
}

/// Whether windows that have an answer may be refused all the same. Contact of ends of bars keeps
/// an account, which pays later what a window seems to gain.
bool Controller::may_refuse() const { return may_go_passively() && !passive_.on_a_line(); }

/// Which body comes upon itself, where passive forms can keep it off itself; empty: none.
std::string Controller::folded() { return may_refuse() ? folds_.look() : std::string(); }

/// Where surfaces come near, or have met in an attempt, of which neither side finds contact in
/// another form.
bool Controller::must_go_passively(const TimeWindow& window) {
  const bool near = std::ranges::any_of(joints_, [&](Joint& joint) {
    if (joint.tied() || !only_passive(joint, bodies_)) return false;
    if (joint.closed()) return true;
    const auto [apart, speed] = joint.watch->approach(joint, bodies_);
    return apart <= near_ways * speed * window.length();
  });
  if (near && !go_passively(window.begin, {}))
    fail(window.begin,
         "surfaces meet that find contact in passive forms alone, but " + passive_.hindrance());
  return near;
}

/// What contact owed the bodies at the end of the last accurate window: their records have told of
/// it.
std::optional<Failed> Controller::give_impulses(double time) {
  const auto owes = [](const Joint& joint) { return joint.contact.impulse != 0.0; };
  if (std::ranges::none_of(joints_, owes)) return std::nullopt;
  prepare({0, time, time}, 1, Sampling::substeps);
  std::optional<Failed> failed = bodies_.advance_all();
  if (!failed) guard_.struck(bodies_.responses());
  for (Joint& joint : joints_) joint.contact.impulse = 0.0;
  return failed;
}

/// All bodies stand at the begin of a window. `reason`: why the accurate method has failed; empty:
/// it was not tried. False: the scene cannot go on so, or does not want to.
bool Controller::go_passively(double time, const std::string& reason) {
  if (!passive_.hindrance().empty() || (!reason.empty() && !may_go_passively())) return false;
  if (std::optional<Failed> failed = give_impulses(time)) {
    fail(failed->time, failed->detail);
    return true;
  }
  if (std::optional<Failed> failed = passive_.enter(time, !reason.empty())) {
    fail(failed->time, failed->detail);
    return true;
  }
  if (!reason.empty()) {
    if (waiting_.accurate < soon) waiting_.wait = std::min(2 * waiting_.wait, longest_wait);
    waiting_.left = waiting_.wait;
    narrator_.passive(time, reason, passive_.statics());
  }
  return true;
}

void Controller::step_passively() {
  if (!goes_on()) return;
  const TimeWindow window = clock_.next();
  if (ends_before(window)) return;
  SpanScope span(bodies_.spans(), "passive window", clock_.windows());
  span.covers(window.begin, window.end);
  for (Joint& joint : joints_)  // some came near since
    if (joint.exchange != nullptr && !joint.exchange->met())
      joint.exchange->introduce(joint, bodies_);
  if (std::optional<Failed> failed = passive_.window(window, records_in(window), joints_))
    return fail(failed->time, failed->detail);
  accept_passively(window);
  go_accurately();
}

/// Energy that an accurate window has gained, beyond what may stand, is taken back at its end from
/// the bodies that touch, and from those that hang together with them by ties. False: they have too
/// little of it, as at first touch, and the window is to be taken back.
bool Controller::repay() {
  std::set<int> touching;
  for (const Joint& joint : joints_)
    for (const Side& side : joint.sides)
      if (joint.closed() && !joint.tied()) touching.insert(side.body);
  if (touching.empty()) return true;
  for (std::size_t before = 0; before < touching.size();) {
    before = touching.size();
    for (const Joint& joint : joints_) {
      const auto& [one, two] = joint.sides;
      if (!joint.tied() || (!touching.contains(one.body) && !touching.contains(two.body))) continue;
      touching.insert({one.body, two.body});
    }
  }
  std::erase_if(touching, [this](int b) { return !std::isfinite(bodies_.describe(b).mass); });
  const bool accounts = passive_.on_a_line();  // bars give back what contact has given them, alone
  double excess = accounts ? guard_.excess(bodies_.responses(), {}, events_.payments(guard_.most()))
                           : guard_.excess(bodies_.responses(), bodies_.struck());
  if (touching.empty() || !(excess > 0.0)) return true;
  if (accounts) excess = std::min(excess, events_.overpaid(guard_.most()));
  if (!(excess > 0.0)) return true;
  const std::vector<int> bodies(touching.begin(), touching.end());
  const std::vector<double> gave = passive_.repay(bodies, excess);
  double left = excess;
  for (const double given : gave) left -= given;
  if (accounts) {
    for (const int b : bodies) bodies_.see_recoil(b, bodies_.response(b).records.back().time);
    events_.repaid(guard_.most(), excess - left);
  } else if (left > guard_.forgiven()) {
    return false;
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) guard_.repaid(bodies[k], gave[k]);
  passive_.count_repaid(excess - left);
  return true;
}

/// Passive windows make no energy, and do not end a run for what accurate ones before have made
/// that could not be judged, when bodies that rested had none yet: they take it back.
void Controller::take_back_growth() {
  const double grown = guard_.overgrown(bodies_.responses());
  if (!(grown > 0.0)) return;
  std::vector<int> moving;
  for (int b = 0; b < bodies_.count(); ++b)
    if (std::isfinite(bodies_.describe(b).mass)) moving.push_back(b);
  const std::vector<double> gave = passive_.repay(moving, grown);
  for (std::size_t k = 0; k < moving.size(); ++k) guard_.repaid(moving[k], gave[k]);
  passive_.count_repaid(std::accumulate(gave.begin(), gave.end(), 0.0));
}

void Controller::accept_passively(const TimeWindow& window) {
  attempt_.reports.clear();
  for (Joint& joint : joints_) {
    if (joint.tied() || joint.exchange == nullptr || joint.closed() || !passive_.pressed(joint))
      continue;
    joint.engage(joint.watch->approach(joint, bodies_).speed);
  }
  fill_reports(false);
  for (const Joint& joint : joints_)
    if (joint.closed() && index(joint.interface) >= scene_.interfaces.size())
      pairs_.push_back(pair_report(joint));
  events_.settle_passively(window, guard_.most());
  if (!passive_.on_a_line() && !passive_.statics()) take_back_growth();
  end_window(window, guard_.look(bodies_.responses()));
}

/// Bodies have left their passive forms; false: one came upon itself by that, or an end upon
/// another one's, and all are back: nodes without mass go to where they are in balance.
bool Controller::leave_apart() {
  if (!folds_.any() && !passive_.on_a_line()) return true;
  prepare({0, clock_.time(), clock_.time()}, 1, Sampling::substeps);
  const bool answered = !bodies_.advance_all();
  const bool apart = !passive_.on_a_line() || std::ranges::all_of(joints_, [&](Joint& joint) {
    return joint.exchange == nullptr || joint.tied() ||
           joint.watch->approach(joint, bodies_).apart > 0.0;
  });
  if (answered && apart && (!folds_.any() || folds_.still_apart())) return true;
  bodies_.restore_all();
  passive_.stay();
  waiting_.left = soon;
  return false;
}

/// Bodies have left their passive forms: joined sides, which move alike by the masses of those, are
/// to do so by the masses of their own schemes [M.122]. False: the run stays on the passive way.
bool Controller::rejoin() {
  if (!passive_.joins()) return true;
  const auto kinetic = [this] {
    const std::vector<double> all = kinetic_energies();
    return std::accumulate(all.begin(), all.end(), 0.0);
  };
  prepare({0, clock_.time(), clock_.time()}, 1, Sampling::substeps);
  waiting_.left = longest_wait;
  if (bodies_.advance_all()) {
    bodies_.restore_all();
    passive_.stay();
    return false;
  }
  const double before = kinetic();
  std::vector<UnlikeStart> unlike;
  if (!unite_velocities(joints_, clock_.time(), bodies_, unlike)) {
    waiting_.left = 0;
    passive_.rejoin(before - kinetic());
    return true;
  }
  if (std::optional<Failed> failed = passive_.enter(clock_.time(), false))
    fail(failed->time, failed->detail);
  return false;
}

/// Back to the accurate method where nothing pressed and all surfaces are well apart: a return in
/// the midst of contact costs a part of the energy. Bodies without inertia have none to lose.
void Controller::go_accurately() {
  if (waiting_.left > 0) --waiting_.left;
  const bool statics = passive_.statics();
  if ((!passive_.quiet() && !statics) || waiting_.left > 0 || !goes_on()) return;
  const bool apart = statics || std::ranges::all_of(joints_, [&](Joint& joint) {
                       if (joint.exchange == nullptr || joint.tied()) return true;
                       const auto [distance, speed] = joint.watch->approach(joint, bodies_);
                       return distance > far_ways * speed * scene_.time.window;
                     });
  if (!apart || !folds_.apart(far_ways)) return;
  if (!passive_.leave(clock_.time(), statics ? anything : lost_by_return * guard_.most())) {
    if (!statics) waiting_.left = soon;
    return;
  }
  if (!leave_apart() || !rejoin()) return;
  waiting_.accurate = 0;
  narrator_.accurate(clock_.time(), statics);
  for (Joint& joint : joints_)
    if (!joint.tied() && joint.exchange != nullptr) joint.disengage();
}

/// Forces of contact are found anew by what follows. Whatever the return costs in the midst of
/// contact: the stage ends here.
bool Controller::stays_passive() {
  if (!passive_.active()) return false;
  if (!passive_.leave(clock_.time(), anything)) return true;
  if (!passive_.statics() && (!leave_apart() || !rejoin())) return true;
  for (Joint& joint : joints_)
    if (!joint.tied() && joint.exchange != nullptr) joint.disengage();
  return false;
}

GivenUp Controller::given_up() const {
  const PassiveLedger passive = passive_.of_all_stages();
  return {.statics = passive_.statics(),
          .windows = passive.windows,
          .halved_windows = passive.halved_windows,
          .rigid_windows = passive.rigid_windows,
          .unanswered = passive.unanswered,
          .near_windows = passive.near_windows,
          .missed = passive.missed,
          .steps = passive.steps,
          .refused = passive.refused,
          .rigid = passive.rigid,
          .shortest_step = passive.shortest_step,
          .unsettled = passive.unsettled,
          .unbalanced = passive.unbalanced,
          .normal = passive.normal,
          .impacts = passive.impacts,
          .friction = passive.friction,
          .damped = passive.damped,
          .switched = passive.switched,
          .push_out = passive.push_out,
          .taken_back = passive.taken_back,
          .owed = passive.owed,
          .repaid = passive.repaid,
          .deepest = passive.deepest,
          .largest = std::max(
              {end_.given_up.largest, guard_.most(), energy_put_in(bodies_, passive_.ledger())}),
          .lost = passive.lost,
          .taken = passive.taken,
          .refused_by = passive.refused_by};
}

}  // namespace abut
