#include "coordinator/coupling/support_distance.hpp"

#include <algorithm>

namespace abut {

namespace {

/// Neither supports nor inertia hold it.
bool is_loose(const Description& body) { return body.stabilised || loose_motions(body) > 0; }

}  // namespace

std::vector<std::optional<int>> support_distances(std::span<const Neighbours> all,
                                                  const Bodies& bodies) {
  std::vector<std::optional<int>> distances(index(bodies.count()));
  for (int b = 0; b < bodies.count(); ++b)
    if (!is_loose(bodies.describe(b))) distances[index(b)] = 0;
  // Lists are short and chains of bodies shorter: until nothing comes nearer.
  for (bool nearer = true; nearer;) {
    nearer = false;
    for (const Neighbours& two : all) {
      for (const std::size_t s : {0u, 1u}) {
        const std::optional<int>& from = distances[index(two.sides[s].body)];
        std::optional<int>& to = distances[index(two.sides[1 - s].body)];
        const int way = two.tied ? 0 : 1;
        if (!from || (to && *to <= *from + way)) continue;
        to = *from + way;
        nearer = true;
      }
    }
  }
  return distances;
}

void see_supports(std::span<const Joint> joints, std::span<const std::array<Side, 2>> contacts,
                  Bodies& bodies) {
  bool loose = false;
  for (int b = 0; b < bodies.count(); ++b) loose = loose || is_loose(bodies.describe(b));
  if (!loose) return;
  std::vector<Neighbours> all;
  for (const Joint& joint : joints) all.push_back({joint.sides, joint.tied()});
  for (const std::array<Side, 2>& sides : contacts) all.push_back({sides});
  bodies.tell_supports(support_distances(all, bodies));
}

}  // namespace abut
