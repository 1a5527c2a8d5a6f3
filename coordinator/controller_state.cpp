// The state list of a run on the coordinator's side, and how a run goes on from one.

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

std::vector<std::byte> Controller::save() {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::named);
  state_of_pairs(archive);
  totals(archive);
  state(archive);
  memory(archive);
  counts(archive);
  archive.finish();
  return bytes;
}

void Controller::load(std::span<const std::byte> bytes) {
  resumed_ = true;
  introduce();
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  state_of_pairs(archive);
  totals(archive);
  state(archive);
  memory(archive);
  counts(archive);
  archive.finish();
  tell_start();
}

void Controller::load_end(std::span<const std::byte> bytes,
                          std::vector<std::optional<HandOver>> handed) {
  staged_ = true;
  handed_ = std::move(handed);
  introduce();
  tell_start();
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  state_of_pairs(archive);
  end_.given_up.largest = totals(archive);
  passive_.begin_stage();
  std::vector<Role> roles;  // chosen for the schemes of this stage
  for (const Joint& joint : joints_) roles.push_back(joint.role);
  state(archive);  // what presses goes on pressing, and files are numbered by all windows
  release_swapped(roles);
  if (!roles_.keep(joints_))
    for (std::size_t j = 0; j < joints_.size(); ++j) joints_[j].role = roles[j];
  EnergyGuard(guard_).state(archive);  // this stage has an account of its own
  std::vector<double> lost_before;
  archive.field("start_lost", lost_before);
  bodies_.ends(archive);
  for (const Joint& joint : joints_) {  // of surfaces that are no more
    if (!is_swapped(joint)) continue;
    for (const Side& side : joint.sides)
      for (Reaction& reaction : bodies_.response(side.body).ports[index(side.port)].reactions)
        reaction = {};
  }
  clock_.anchor();
}

void Controller::tell_start() {
  narrator_.start(scene_.time.begin, scene_.time.end,
                  std::span(joints_).first(scene_.interfaces.size()), !broad_phase_.empty());
}

/// What the run has done on this side of the messages, of which the state hash is: the same however
/// often records and fields are wanted.
void Controller::state(Archive& archive) {
  clock_.state(archive);
  events_.state(archive);
  archive.field("halvings", halvings_);
  for (Joint& joint : joints_) joint.state(archive);
}

/// What the windows to come depend on beside: how far is flown at once, what the guard saw at the
/// ends of flights, the latest replies, and what iterations learned. What the next window fills
/// anew is not listed.
void Controller::memory(Archive& archive) {
  guard_.state(archive);
  archive.field("start_lost", start_lost_);
  bodies_.state(archive);
  whole(archive, "flight_limit", flight_.limit);
  archive.field("grounded", flight_.grounded);
  for (Joint& joint : joints_) joint.memory(archive);
  roles_.state(archive);
  passive_.state(archive);
  crossing_.state(archive);
  whole(archive, "wait", waiting_.wait);
  whole(archive, "left", waiting_.left);
  whole(archive, "accurate", waiting_.accurate);
  whole(archive, "near", waiting_.near);
  schwarz_.state(archive);
  if (event_) event_->state(archive);
}

/// What a run counts over all its stages; the largest energy [J] so far, where that of the stages
/// before is in end_.
double Controller::totals(Archive& archive) {
  bodies_.counts(archive);
  archive.field("contact_windows", end_.contact_windows);
  double largest = archive.writing() ? given_up().largest : 0.0;
  archive.field("largest_before", end_.given_up.largest);
  archive.field("largest", largest);
  passive_.totals(archive);
  return largest;
}

/// What a stage counts and tells at its end, of all its windows; and how long these were, which a
/// resumed run may change.
void Controller::counts(Archive& archive) {
  double window = scene_.time.window;
  archive.field("window", window);
  if (window != scene_.time.window) clock_.anchor();
  list(archive, "overlaps", end_.overlaps, [](Archive& a, Overlap& overlap) {
    for (int& body : overlap.body) whole(a, "body", body);
    a.field("depth", overlap.depth);
    field(a, "place", overlap.place);
    a.field("time", overlap.time);
  });
  overlaps_.state(archive);
  narrator_.state(archive);
}

}  // namespace abut
