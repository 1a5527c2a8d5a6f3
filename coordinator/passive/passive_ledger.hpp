#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "base/archive_lists.hpp"

namespace abut {

/// What passive steps have taken from the bodies, and what they had to do for it.
struct PassiveLedger {
  double normal = 0.0;      // [J] lost in normal contact
  double impacts = 0.0;     // [J] of it between rigid bodies, as restitution has it
  double friction = 0.0;    // [J] by friction, which is physics
  double push_out = 0.0;    // [J] given to part what was too near, out of what normal contact lost
  double damped = 0.0;      // [J] taken from bodies that were held rigid for an instant
  double taken_back = 0.0;  // [J] that steps had given a body beside contact, no more
  double repaid = 0.0;      // [J] gained in accurate windows and taken back from bodies that touch
  double switched = 0.0;    // [J] lost where bodies changed their form
  double owed = 0.0;  // [J] of normal contact that rows give back as they part, after the last step
  std::int64_t steps = 0, refused = 0, windows = 0, rigid = 0;
  // windows in which steps were halved, in which bodies were held rigid; times that the accurate
  // method had no answer
  std::int64_t halved_windows = 0, rigid_windows = 0, unanswered = 0;
  std::int64_t near_windows = 0;  // of the accurate method that have nearly converged
  double missed = 0.0;            // most of the residual in such a window
  double deepest = 0.0;           // [m] behind a partner's surface
  double shortest_step = 0.0;     // [s]; 0: none was taken
  std::int64_t unsettled = 0;     // steps of statics after which bodies did not rest yet
  double unbalanced = 0.0;        // most that such a step left, over the most that any began with

  // By body, as long as one has any. [J] of its deforming side's normal contact; [J] that damping
  // and changes of form took from it; steps that it refused
  std::vector<double> lost, taken, refused_by;
  /// [J] of friction, by surfaces that touched: body, port, body, port, the lower side first.
  using Pair = std::array<int, 4>;
  std::map<Pair, double> rubbed;

  /// [J] what accuracy was given up; friction would be there anyway.
  double given_up() const { return normal - push_out + damped + switched; }
  static void add(std::vector<double>& values, int body, double value) {
    const std::size_t at = static_cast<std::size_t>(body);
    if (values.size() <= at) values.resize(at + 1, 0.0);
    values[at] += value;
  }
  static Pair pair_of(int one, int its_port, int other, int its_other) {
    const Pair pair{one, its_port, other, its_other}, turned{other, its_other, one, its_port};
    return std::min(pair, turned);
  }
  /// Both stages' together.
  PassiveLedger after(const PassiveLedger& earlier) const {
    PassiveLedger all = *this;
    for (double PassiveLedger::*sum :
         {&PassiveLedger::normal, &PassiveLedger::impacts, &PassiveLedger::friction,
          &PassiveLedger::push_out, &PassiveLedger::damped, &PassiveLedger::taken_back,
          &PassiveLedger::repaid, &PassiveLedger::switched})
      all.*sum += earlier.*sum;
    for (std::int64_t PassiveLedger::*count :
         {&PassiveLedger::steps, &PassiveLedger::refused, &PassiveLedger::windows,
          &PassiveLedger::rigid, &PassiveLedger::halved_windows, &PassiveLedger::rigid_windows,
          &PassiveLedger::unanswered, &PassiveLedger::unsettled, &PassiveLedger::near_windows})
      all.*count += earlier.*count;
    for (std::vector<double> PassiveLedger::*of :
         {&PassiveLedger::lost, &PassiveLedger::taken, &PassiveLedger::refused_by})
      for (std::size_t b = 0; b < (earlier.*of).size(); ++b)
        add(all.*of, static_cast<int>(b), (earlier.*of)[b]);
    for (const auto& [pair, heat] : earlier.rubbed) all.rubbed[pair] += heat;
    all.deepest = std::max(deepest, earlier.deepest);
    all.missed = std::max(missed, earlier.missed);
    all.unbalanced = std::max(unbalanced, earlier.unbalanced);
    const double before = earlier.shortest_step;
    if (before > 0.0 && (shortest_step == 0.0 || before < shortest_step))
      all.shortest_step = before;
    return all;
  }
  /// What bodies without inertia give up is no energy of motion.
  void leave_out_energies() {
    normal = impacts = friction = push_out = damped = taken_back = repaid = switched = owed = 0.0;
    lost.clear();
    taken.clear();
    rubbed.clear();
  }
  void state(Archive& archive) {
    std::vector<std::pair<Pair, double>> pairs(rubbed.begin(), rubbed.end());
    list(archive, "rubbed", pairs, [](Archive& a, auto& each) {
      for (int& side : each.first) whole(a, "side", side);
      a.field("heat", each.second);
    });
    rubbed = {pairs.begin(), pairs.end()};
    archive.field("normal", normal);
    archive.field("impacts", impacts);
    archive.field("friction", friction);
    archive.field("push_out", push_out);
    archive.field("damped", damped);
    archive.field("taken_back", taken_back);
    archive.field("repaid", repaid);
    archive.field("switched", switched);
    archive.field("owed", owed);
    archive.field("steps", steps);
    archive.field("refused", refused);
    archive.field("windows", windows);
    archive.field("rigid", rigid);
    archive.field("halved_windows", halved_windows);
    archive.field("rigid_windows", rigid_windows);
    archive.field("unanswered", unanswered);
    archive.field("near_windows", near_windows);
    archive.field("missed", missed);
    archive.field("lost", lost);
    archive.field("taken", taken);
    archive.field("refused_by", refused_by);
    archive.field("deepest", deepest);
    archive.field("shortest_step", shortest_step);
    archive.field("unsettled", unsettled);
    archive.field("unbalanced", unbalanced);
  }
};

}  // namespace abut
