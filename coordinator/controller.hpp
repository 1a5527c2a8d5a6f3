#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "coordinator/couple.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/energy_guard.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The time loop: walks controller windows from the scene's begin to its end.
///
///   run           observe the start, then fly free or step until the end
///   fly_free      nothing can touch before the horizon: several windows in one request per body,
///   step_window   one window: tried, judged, and accepted or tried again
class Controller {
 public:
  /// The bodies must outlive the controller. `interrupted` may be null.
  Controller(const Scene& scene, std::vector<Subdomain*> bodies, std::vector<Observer*> observers,
             const std::atomic<bool>* interrupted = nullptr);

  /// Walks to the end and tells the observers. RunError of a lost peer passes through after they
  /// were told.
  RunEnd run();

 private:
  struct Partition {         // of the bodies by the closed interfaces; kept while those stay
    std::vector<int> roles;  // by interface: kinematic side, or -1 when open
    std::vector<Island> islands;
    std::vector<int> free;  // bodies in no island
  };
  struct Attempt {  // of one window
    std::optional<Failed> failed;
    std::vector<SchwarzReport> reports;  // by island
    bool converged() const;
  };

  void observe_start();
  void give_up(const RunError& error, bool interrupted, double wall_seconds);
  bool fly_free();
  void step_window();
  enum class Verdict { accept, again, stop };
  Verdict judge(TimeWindow& window);
  const Attempt& advance(const TimeWindow& window);  // valid until the next one
  const Partition& partition();
  bool handle_trouble(const Attempt& attempt, TimeWindow& window);
  void accept(const TimeWindow& window, const Attempt& attempt);
  std::optional<double> engage_touching();
  void engage(int interface, double speed);
  std::optional<double> first_event(const TimeWindow& window);
  double common_end(const TimeWindow& window, double time) const;
  bool release_kicks(const TimeWindow& window);
  bool shorten(TimeWindow& window) const;
  void settle(const TimeWindow& window);
  void pay(Interface& interface);
  void narrate(Interface& interface);
  void disengage(Interface& interface, const TimeWindow& window);
  double least_force(const Interface& interface) const;
  void tell_closed(const Interface& interface, double time, double speed);
  void tell_opened(const Interface& interface, double time);

  TimeWindow next_window() const;
  void advance_clock(double end, bool whole);
  void tie();
  void choose_roles(int interface);
  void apply_criteria_at_start(const TimeWindow& window);
  void prepare(const TimeWindow& window, int records, Sampling sampling);
  void fill_reports(const Attempt* attempt);  // null: all flew free
  void watch_internal();
  bool is_whole(const TimeWindow& window) const;
  int records_in(const TimeWindow& window) const;
  int windows_to_fields() const;  // fields are asked for between flights
  double shortest_step() const;
  double longest_step() const;
  bool running() const;
  void fail(double time, const std::string& text);
  void tell(const RunEvent& event);
  std::string blamed(const std::string& text) const;  // the body that a text names, or empty
  void watch_energy(double time, EnergyGuard::Verdict verdict);
  std::vector<bool> conserving_bodies() const;
  void emit(RunEvent::Kind kind, double time, const std::string& subject, const std::string& text,
            std::map<std::string, double> values = {});
  std::uint64_t state_hash();
  RunEnd finish(double wall_seconds);

  const Scene& scene_;
  Bodies bodies_;
  std::vector<Observer*> observers_;
  const std::atomic<bool>* interrupted_;
  Coupling coupling_;
  std::vector<Joint> joints_;
  Schwarz schwarz_;

  // The clock: windows are counted from an anchor, which is the begin or the last event.
  double anchor_;           // [s]
  std::int64_t since_ = 0;  // whole windows since the anchor
  double time_;             // [s]
  int halvings_ = 0;
  double fastest_touch_ = 0.0;    // [m/s] of all first touches
  double force_reference_ = 0.0;  // [N] largest contact force of the run
  int longest_flight_ = 1;  // windows in one request (flight_work.hpp)
  int flight_limit_ = 1;    // the same at present
  bool grounded_ = false;  // free flight came too near: step once
  RunEnd end_;
  Partition partition_;
  Attempt attempt_;
  std::vector<InterfaceReport> reports_;
  EnergyGuard energy_guard_;
  ContactHistory history_;
};

}  // namespace abut
