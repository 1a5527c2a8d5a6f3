#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/coupling/joint.hpp"
#include "coordinator/passive/common_step.hpp"
#include "coordinator/passive/passive_record.hpp"

namespace abut {

/// The passive way through windows: all bodies in their passive forms, steps that are halved as
/// often as it takes, and bodies held rigid for an instant as the last resort. It always ends.
///
///   enter    bodies change to their passive forms
///   window   steps from its begin to its end
///   leave    back to the bodies' own schemes
class PassiveWay {
 public:
  /// `pairs`: of surfaces that may touch; `ties`: of those that are one, none where some of the run
  /// have no passive form. `window` [s]: the scene's. Bodies and rows of ties must outlive it.
  PassiveWay(std::vector<TouchingPair> pairs, std::optional<std::vector<PassiveTie>> ties,
             Bodies& bodies, double window);
  ~PassiveWay();

  /// Why the scene cannot take this way, for people; empty: it can.
  const std::string& hindrance() const { return hindrance_; }
  bool active() const { return active_; }
  /// Whether its surfaces are ends of bars.
  bool on_a_line() const;
  /// Whether ties hold bodies together.
  bool joins() const { return ties_ && !ties_->empty(); }
  /// Whether no body has inertia: then windows owe each other nothing, and steps end at rest
  /// [M.154].
  bool statics() const;
  const PassiveLedger& ledger() const { return ledger_; }
  PassiveLedger of_all_stages() const { return ledger_.after(earlier_); }

  /// The bodies stand at a time at which they may be saved. `unanswered`: the accurate method was
  /// tried and had no answer.
  [[nodiscard]] std::optional<Failed> enter(double time, bool unanswered);
  /// Advances all bodies and fills their responses, with so many records.
  [[nodiscard]] std::optional<Failed> window(const TimeWindow& window, int records,
                                             std::span<const Joint> joints);
  /// False: a body cannot, or all together would lose more than so much [J] by it, and all stay as
  /// they are.
  bool leave(double time, double may_lose);
  /// The bodies have been restored to where they were before they left.
  void stay() { active_ = true; }
  /// Takes energy [J] from the motion by which bodies deform that are in their own schemes, in the
  /// shares of their kinetic energies; momentum and angular momentum stay. Their last records tell
  /// of the state after it. Returns what each of them gave.
  std::vector<double> repay(std::span<const int> bodies, double joules);
  /// The window in which they did is accepted.
  void count_near(double missed) {
    ++ledger_.near_windows;
    ledger_.missed = std::max(ledger_.missed, missed);
  }
  void count_repaid(double joules) { ledger_.repaid += joules; }
  /// They have left, and velocities of joined sides were made one, at this cost [J].
  void rejoin(double lost);
  /// Whether nothing pressed in the last window.
  bool quiet() const { return quiet_; }
  /// Whether surfaces pressed in the last window, of a joint.
  bool pressed(const Joint& joint) const;
  /// [J] that friction took between the surfaces of a joint since the run began.
  double rubbed(const Joint& joint) const;

  void state(Archive& archive);
  /// What was given up so far, in this stage and in those before.
  void totals(Archive& archive);
  /// The totals are those of the stage before.
  void begin_stage();

 private:
  std::string find_hindrance() const;
  void make();
  bool step(double begin, double end, PassiveRecord& record, bool lenient);
  std::optional<Failed> advance_to(double end, double& time, PassiveRecord& record);
  bool hold_rigid();
  void settle(double begin, double end, bool lenient);
  void note_pressed();

  std::vector<TouchingPair> pairs_;
  std::optional<std::vector<PassiveTie>> ties_;
  Bodies& bodies_;
  std::string hindrance_;
  bool active_ = false, quiet_ = true;
  bool halved_ = false;             // a step of the window was shorter than the nominal one
  PassiveLedger ledger_, earlier_;  // of the stage; of those before
  bool were_statics_ = false;       // which had no inertia
  double window_;                   // [s] of the scene
  double nominal_ = 0.0;            // [s] the longest step
  int level_ = 0;                   // steps are nominal / 2^level
  int good_ = 0;                    // steps since the level changed
  int held_ = 0;                    // times in a row that bodies were held rigid
  double farthest_ = 0.0;           // [m] of statics: by a step at most, since enter()
  std::vector<std::array<int, 4>> pressed_;  // body, port, body, port
  std::unique_ptr<TouchingSurfaces> surfaces_;
  std::unique_ptr<NearRows> near_;
  std::unique_ptr<CommonStep> step_;
};

}  // namespace abut
