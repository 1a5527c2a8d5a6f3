#include "coordinator/stage_event.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "base/index.hpp"
#include "coordinator/coupling/nearness.hpp"
#include "coordinator/coupling/watch.hpp"
#include "coordinator/touching_pairs.hpp"

namespace abut {

namespace {

/// Ends of bars, whose windows end where they touch or part.
bool is_of_ends(const Joint& joint, const Bodies& bodies) {
  return bodies.port(joint.sides[0]).geometry.dim == 1;
}

}  // namespace

StageEvent::StageEvent(const Scene& scene)
    : awaits_contact_(std::holds_alternative<UntilContact>(*scene.time.until)),
      name_(std::visit([](const auto& event) { return event.interface; }, *scene.time.until)),
      interface_(static_cast<int>(scene.interfaces.size())) {
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i)
    if (scene.interfaces[i].first == name_) interface_ = static_cast<int>(i);
}

std::string StageEvent::words() const {
  return fmt::format("the {} of contact '{}'", awaits_contact_ ? "begin" : "end", name_);
}

bool StageEvent::comes(std::span<const Joint> joints, const TimeWindow& window,
                       const Bodies& bodies, bool passively) const {
  return awaits_contact_ && std::ranges::any_of(joints, [&](const Joint& joint) {
           if (joint.interface != interface_) return false;
           if (is_of_ends(joint, bodies)) return joint.closed();
           if (!passively && !only_passive(joint, bodies)) return false;
           return joint.closed() ||
                  (!bodies.taken_back() && may_meet(joint, bodies, window.length()));
         });
}

bool StageEvent::came(std::span<const Joint> joints, const Bodies& bodies) const {
  return awaits_contact_ && std::ranges::any_of(joints, [&](const Joint& joint) {
           return joint.interface == interface_ && !is_of_ends(joint, bodies) &&
                  joint.watch->show(joint, bodies).closed;
         });
}

void StageEvent::remember(const Bodies& bodies) {
  if (!awaits_contact_ || bodies.taken_back()) return;
  before_.assign(bodies.responses().begin(), bodies.responses().end());
}

bool StageEvent::recall(Bodies& bodies) const {
  if (!bodies.taken_back()) return true;
  if (before_.empty()) return false;  // resumed behind an attempt
  for (int b = 0; b < bodies.count(); ++b) bodies.response(b) = before_[index(b)];
  bodies.see_anew();
  return true;
}

void StageEvent::see(std::span<const InterfaceReport> reports) {
  const std::size_t i = index(interface_);  // none where no two bodies can meet
  presses_ = i < reports.size() && reports[i].closed;
  pressed_ = pressed_ || presses_;
}

bool StageEvent::is_over(std::span<const Joint> joints, const TimeWindow& next,
                         const Bodies& bodies) const {
  return !awaits_contact_ && pressed_ && !presses_ &&
         std::ranges::none_of(joints, [&](const Joint& joint) {
           if (joint.interface != interface_) return false;
           return is_of_ends(joint, bodies) ? joint.closed()
                                            : may_meet(joint, bodies, next.length());
         });
}

}  // namespace abut
