// Stages that an event ends, and bodies that go on as another model or on another mesh.

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/controller.hpp"

namespace abut {

bool Controller::is_swapped(const Joint& joint) const {
  return !handed_.empty() && std::ranges::any_of(joint.sides, [this](const Side& side) {
    return handed_[index(side.body)].has_value();
  });
}

/// Joints of bodies that are other ones now begin as those of a scene do, with their roles still
/// to be chosen. Points of surfaces that press, stick or have rubbed are not those of the new ones.
void Controller::release_swapped(const std::vector<Role>& roles) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    if (!is_swapped(joint)) continue;
    const auto [one, other] = joint.contact.rubbed;
    const char* state = joint.tied()                   ? nullptr
                        : joint.pressing()             ? "presses"
                        : joint.contact.impulse != 0.0 ? "is owed an impulse"
                        : std::max(one, other) > 0.0   ? "has rubbed"
                                                       : nullptr;
    if (state != nullptr)
      throw RunError(fmt::format("{} where a stage begins in which one of its bodies has another "
                                 "model or mesh",
                                 state),
                     fmt::format("contact '{}'", joint.name),
                     "Change the body before its contact begins, or, without friction, after it "
                     "has ended: time: {until: {contact: NAME}} or {until: {apart: NAME}}");
    joint.contact = {.rubbed = joint.contact.rubbed};
    joint.role = roles[j];
  }
}

/// Bodies have told of themselves at the stage's begin.
void Controller::tell_swaps() {
  for (std::size_t b = 0; b < handed_.size(); ++b) {
    if (!handed_[b]) continue;
    const int body = static_cast<int>(b);
    const Description& now = bodies_.describe(body);
    Swap swap{
        clock_.time(),      now.name,    handed_[b]->model, now.model, {handed_[b]->mass, now.mass},
        handed_[b]->record, record(body)};
    narrator_.swap(swap);
  }
}

/// Whether contact that the stage waits for begins with a window, at whose begin all stand.
bool Controller::ends_before(const TimeWindow& window) {
  if (!event_ || !event_->comes(joints_, window, bodies_, passive_.active())) return false;
  stop();
  return true;
}

/// Whether it has begun in a window that has its answer: bodies go back to where they are apart.
bool Controller::ends_in_window() {
  if (!event_ || attempt_.failed || !attempt_.converged() || !event_->came(joints_, bodies_))
    return false;
  bodies_.restore_all();
  stop();
  return true;
}

/// The latest replies become those of the time at which all stand.
void Controller::stop() {
  if (!event_->recall(bodies_)) {
    prepare({0, clock_.time(), clock_.time()}, 1, Sampling::substeps);
    if (std::optional<Failed> failed = bodies_.advance_all()) fail(failed->time, failed->detail);
  }
  event_->stop();
  clock_.stop();
}

}  // namespace abut
