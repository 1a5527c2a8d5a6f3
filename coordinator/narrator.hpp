#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "coordinator/coupling/contact_account.hpp"
#include "coordinator/coupling/watch.hpp"
#include "coordinator/energy_guard.hpp"
#include "coordinator/passive/passive_ledger.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// Puts what happens in a run into words, for its observers.
class Narrator {
 public:
  /// Bodies and observers must outlive it. `units`: the scene's words for those of SI (unit_words);
  /// empty: these.
  Narrator(const Bodies& bodies, std::vector<Observer*> observers,
           std::map<std::string, std::string> units)
      : bodies_(bodies), observers_(std::move(observers)), units_(std::move(units)) {}

  /// `joints`: one of every interface that the scene writes. `everything`: there is an interface of
  /// any two surfaces beside them.
  void start(double begin, double end, std::span<const Joint> joints, bool everything);
  void state(Archive& archive);
  void window(const WindowReport& report);
  void end(const RunEnd& end);
  /// The same after an error: all observers still write what they can.
  void end_after_error(const RunEnd& end);

  void closed(const Joint& joint, double time, double speed);
  void opened(const Joint& joint, double time);
  void inside(const Joint& joint, const ContactChange& change);
  /// Warns where the side that finds a contact of surfaces has the longer steps.
  void found(const Joint& joint, double time);
  /// The contact spring of a joint lowers its Neumann side's stable step to a limit [s].
  void lowered_step(const Joint& joint, double time, double limit);
  /// Warns of interference that bodies without inertia take at once.
  void pressed_in(const Joint& joint, double time);
  /// Bodies that are in each other, with the joints that there are.
  void overlap(const Overlap& overlap, std::span<const Joint> joints, bool all_touch);
  /// An interface whose sides went past each other.
  void never_met(const std::string& name, double time);
  /// Bodies go on in their passive forms; the first times are told. `statics`: without inertia.
  void passive(double time, const std::string& reason, bool statics);
  void accurate(double time, bool statics);
  void given_up(const RunEnd& end);
  /// A body that goes on as another model or on another mesh.
  void swap(const Swap& swap);
  /// A stage ends by its time, and not by the event that it waits for.
  void not_come(const std::string& event, double time);
  void energy(const EnergyGuard& guard, std::span<const Joint> joints, double time);
  void warning(double time, const std::string& subject, const std::string& text);
  void failure(double time, const std::string& text);
  /// An error that ends the program, which says it on the terminal as well.
  void thrown(double time, const std::string& text);

  std::string words_of(const EnergyGuard& guard, std::span<const Joint> joints) const;
  /// A text with the words of the scene's units.
  std::string in_units(const std::string& text) const;

 private:
  std::string remedies(std::span<const Joint> joints) const;
  void tell(RunEvent event);
  std::string blamed(const std::string& text) const;  // the body that a text names, or empty

  const std::string& interface_of(const Joint& joint) const { return interfaces_[joint.interface]; }

  const Bodies& bodies_;
  std::vector<Observer*> observers_;
  std::map<std::string, std::string> units_;
  std::vector<std::string> interfaces_;
  int told_passive_ = 0;
};

}  // namespace abut
