// Of a scene where everything may touch everything, the pairs that come near during a run.

#include <algorithm>

#include "base/index.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/couple.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/coupling/support_distance.hpp"

namespace abut {

namespace {

/// Pairs of a scene where everything may touch everything are joined when they may meet within so
/// many: contact begins to look at its joints within the next one or two.
constexpr double watched_windows = 4.0;

}  // namespace

/// Pairs that may meet within the next windows are watched one by one from now on.
void Controller::join_near() {
  if (broad_phase_.empty()) return;
  const std::size_t known = joints_.size();
  join(broad_phase_.near(bodies_, watched_windows * scene_.time.window));
  for (auto& pair : std::span(joints_).subspan(known)) narrator_.pressed_in(pair, clock_.time());
}

void Controller::join(std::span<const PortPair> pairs) {
  if (scene_.stages.empty()) see_supports(joints_, pairs, bodies_);
  for (const PortPair& pair : pairs) {
    roles_.join(joints_.emplace_back(make_pair(scene_, pair, bodies_)));
    broad_phase_.join(pair);
  }
}

/// Joints of pairs that came near during the run, and in which order the bodies met.
void Controller::state_of_pairs(Archive& archive) {
  const std::size_t written = scene_.interfaces.size();
  std::vector<PortPair> pairs;
  for (std::size_t j = written; j < joints_.size(); ++j) pairs.push_back(joints_[j].sides);
  list(archive, "pairs", pairs, [](Archive& a, PortPair& pair) {
    for (Side& side : pair) {
      whole(a, "body", side.body);
      whole(a, "port", side.port);
    }
  });
  if (!archive.writing()) join(pairs);
  std::vector<std::int32_t> met;
  if (archive.writing()) {
    for (std::size_t j = written; j < joints_.size(); ++j)
      if (joints_[j].exchange->met()) met.push_back(static_cast<std::int32_t>(j));
    std::ranges::sort(met, {}, [this](int j) { return *joints_[j].exchange->met(); });
  }
  field(archive, "met", met);
  for (const int j : met) joints_[j].exchange->introduce(joints_[j], bodies_);
}

}  // namespace abut
