#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "contract/hand_over.hpp"
#include "coordinator/attempt.hpp"
#include "coordinator/contact_events.hpp"
#include "coordinator/couple.hpp"
#include "coordinator/energy_guard.hpp"
#include "coordinator/narrator.hpp"
#include "coordinator/overlap_search.hpp"
#include "coordinator/passive/crossing_watch.hpp"
#include "coordinator/passive/fold_watch.hpp"
#include "coordinator/passive/passive_way.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/stage_event.hpp"
#include "coordinator/window_clock.hpp"

namespace abut {

/// Between two windows of a run.
struct Pause {
  double time = 0.0;         // [s]
  std::int64_t windows = 0;  // accepted so far
  bool last = false;         // the end is reached
  bool interrupted = false;  // no window follows for now
};

/// The time loop: walks controller windows from the scene's begin to its end.
///
///   run           observe the start, then fly free or step until the end
///   join_near     where everything may touch everything: pairs that came near are watched
///   fly_free      nothing can touch before the horizon: several windows in one request per body
///   step_window   one window: tried, judged, and accepted or tried again
///   judge         what becomes of a window that was tried
///   go_passively  what the iteration cannot take, bodies take passively (controller_passive.cpp)
///
/// When windows are cut and what contact carries on is ContactEvents' affair; the iteration,
/// Schwarz'; what is told, the Narrator's.
class Controller {
 public:
  /// The bodies must outlive it. `interrupted`: the run is to end between windows; may be null.
  Controller(const Scene& scene, std::vector<Subdomain*> bodies, std::vector<Observer*> observers,
             const std::atomic<bool>* interrupted = nullptr);

  /// Walks to the end and tells the observers. An error passes through after they were told: a lost
  /// peer, what a body cannot take, lack of memory.
  RunEnd run();

  /// The state of the run on this side of the messages, between windows: all that the windows to
  /// come depend on, beside the scene and the bodies' own states.
  std::vector<std::byte> save();
  /// Before `run`, which then goes on from there and tells nothing of the start. Tells the bodies
  /// whom they have met; then they must be given their states. Throws RunError where bytes are of
  /// another scene.
  void load(std::span<const std::byte> bytes);
  /// The same of the run whose end is the begin of this stage: it begins as a scene does, where
  /// bodies stand, and with those that have met. `handed`: by body, of those that are another one
  /// now; throws RunError where these touch.
  void load_end(std::span<const std::byte> bytes, std::vector<std::optional<HandOver>> handed = {});
  /// Tells the observers of an error: in place of `run`, where the run cannot go on.
  void give_up(const std::exception& error, bool interrupted = false, double wall_seconds = 0.0);
  const BodyRecord& record(int body) const { return bodies_.response(body).records.back(); }
  /// Who is told what the run's time goes into: "window", "flight", "island" and so on.
  void tell_spans(SpanSink sink) { bodies_.tell_spans(std::move(sink)); }
  const SpanSink& spans() const { return bodies_.spans(); }
  bool stays_passive();  // where the stage ends; bodies leave their passive forms if they can
  /// Called by `run` before every window or flight, and after the last one of a run that has not
  /// failed; may call `save`.
  std::function<void(const Pause&)> between_windows;

 private:
  struct Judgement {
    // again: the same window, as joints have changed; cut: the same up to an earlier end; fail: the
    // run
    enum class Verdict { accept, again, cut, fail };
    Verdict verdict = Verdict::accept;
    double end = 0.0;    // [s] of a window that is cut
    std::string reason;  // of a failure
    bool final = false;  // no other way takes the window either
  };
  struct Flight {                // how many windows are flown free in one request
    int longest = 1, limit = 1;  // (flight_work.hpp), and at present
    bool grounded = false;       // came too near: step once
  };
  struct Waiting {  // [windows] in which bodies stay passive before the accurate method is tried
    int wait = 2, left = 0, accurate = 0;
    int near = 0;  // accurate ones that have nearly converged, one after the other, until now
  };

  void introduce();
  bool wants_accelerations() const;
  void start();
  void want_opening_accelerations(bool wanted);
  void unite_start();
  std::vector<double> kinetic_energies() const;
  void tell_lost_at_start();
  bool running() const;
  bool goes_on() const;
  void pause();
  void join_near();
  void join(std::span<const PortPair> pairs);
  bool fly_free();
  void step_window();
  TimeWindow next_window();
  void advance(const TimeWindow& window);
  Judgement judge(const TimeWindow& window);
  void try_window(const TimeWindow& window);
  Judgement judge_ways(const TimeWindow& window);
  std::optional<Failed> made_by_themselves(const TimeWindow& window) const;
  Judgement judge_trouble(const TimeWindow& window);
  Judgement halved(const TimeWindow& window, const std::string& why);
  Judgement judge_springs(const TimeWindow& window, double before);
  void accept(const TimeWindow& window);
  void end_window(const TimeWindow& window, EnergyGuard::Verdict energy);
  int windows_to_fly();
  void prepare(const TimeWindow& window, int records, Sampling sampling);
  int records_in(const TimeWindow& window) const;
  void fill_reports(bool flown);
  PairReport pair_report(const Joint& joint) const;
  void note_friction();
  void note_near(const TimeWindow& window);
  double dissipated(const Joint& joint) const;
  void watch_energy(EnergyGuard::Verdict verdict);
  void watch_passing(std::int64_t windows_before);
  void look_for_overlaps();
  void look_for_passed();
  void judge(int body);
  bool may_go_passively() const;
  bool nearly_converged() const;
  int most_halvings() const;
  bool may_refuse() const;
  std::string folded();
  bool must_go_passively(const TimeWindow& window);
  std::optional<Failed> give_impulses(double time);
  bool go_passively(double time, const std::string& reason);
  void step_passively();
  bool repay();
  void take_back_growth();
  void accept_passively(const TimeWindow& window);
  void go_accurately();
  GivenUp given_up() const;
  void tell_losses();
  bool leave_apart();
  bool rejoin();
  void fail(double time, const std::string& text);
  bool is_swapped(const Joint& joint) const;
  void release_swapped(const std::vector<Role>& roles);
  void tell_swaps();
  bool ends_before(const TimeWindow& window);
  bool ends_in_window();
  void stop();
  void state(Archive& archive);
  double totals(Archive& archive);
  void memory(Archive& archive);
  void counts(Archive& archive);
  void tell_start();  // of a run that goes on
  void state_of_pairs(Archive& archive);
  RunEnd finish(double wall_seconds);

  const Scene& scene_;
  Bodies bodies_;
  const std::atomic<bool>* interrupted_;
  Narrator narrator_;
  std::vector<Joint> joints_;  // the scene's, and of other pairs those that came near
  BroadPhase broad_phase_;
  Partition partition_;
  Schwarz schwarz_;
  WindowClock clock_;
  Roles roles_;
  ContactEvents events_;
  EnergyGuard guard_;
  std::vector<double> start_lost_;  // [J] by body, where ties made velocities one
  OverlapSearch overlaps_;
  PassiveWay passive_;
  CrossingWatch crossing_;
  FoldWatch folds_;
  Waiting waiting_;
  Flight flight_;
  std::int64_t halvings_ = 0;
  Attempt attempt_;
  std::vector<InterfaceReport> reports_;
  std::vector<PairReport> pairs_;
  RunEnd end_;
  bool resumed_ = false, staged_ = false, settles_ = false;  // it settles: springs hold a body
  std::vector<std::optional<HandOver>> handed_;  // by body; empty: none is another one now
  std::optional<StageEvent> event_;              // none: time.end alone ends the stage
};

}  // namespace abut
