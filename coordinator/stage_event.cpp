#include "coordinator/stage_event.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "base/index.hpp"
#include "coordinator/coupling/watch.hpp"
#include "coordinator/touching_pairs.hpp"

namespace abut {

namespace {

/// Ways that surfaces can come in a window: those nearer than this may meet in it.
constexpr double awaited_ways = 1.5;

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

bool StageEvent::comes(std::span<Joint> joints, const TimeWindow& window,
                       const Bodies& bodies) const {
  return awaits_contact_ && std::ranges::any_of(joints, [&](Joint& joint) {
           if (joint.interface != interface_) return false;
           if (joint.closed()) return true;
           if (!only_passive(joint, bodies)) return false;
           const auto [apart, speed] = joint.watch->approach(joint, bodies);
           return apart <= awaited_ways * speed * window.length();
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
  pressed_ = pressed_ || (i < reports.size() && reports[i].closed);
}

bool StageEvent::is_over(std::span<const Joint> joints) const {
  return !awaits_contact_ && pressed_ && std::ranges::none_of(joints, [this](const Joint& joint) {
    return joint.interface == interface_ && joint.closed();
  });
}

}  // namespace abut
