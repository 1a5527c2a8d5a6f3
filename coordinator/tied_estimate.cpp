#include "coordinator/tied_estimate.hpp"

#include <algorithm>

#include "coordinator/couple.hpp"
#include "coordinator/coupling/exchange_parts.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/tie_kernel_plan.hpp"

namespace abut {

namespace {

TieLayout layout_of(const Island& island, std::span<const Joint> joints,
                    const std::vector<Tie*>& tie_of, const Bodies& bodies, double window) {
  TieLayout layout;
  for (const int j : island.joints) {
    const Joint& joint = joints[j];
    std::array<int, 2> counts;
    for (const std::size_t s : {0u, 1u})
      counts[s] = substeps_of(bodies, joint.sides[s], {0, 0.0, window}).count;
    layout.add(joint, *tie_of[j], counts, 0);
  }
  layout.arrange(bodies);
  return layout;
}

Estimate::Ties ties_of(const TieLayout& layout, const TieKernelOptions& options,
                       const Bodies& bodies) {
  constexpr double mebi = 1048576.0;
  const TieKernelPlan plan = plan_tie_kernel(layout, options, bodies);
  Estimate::Ties ties;
  ties.banded = plan.banded;
  ties.narrow = plan.narrow;
  ties.used = options.used;
  ties.memory_mib = plan.bytes / mebi;
  ties.probes = plan.probes;
  ties.linear = std::ranges::all_of(layout.parts, [&bodies](const TieLayout::Part& part) {
    return part.stands || bodies.describe(part.body).linear;
  });
  const auto floats = [&bodies](const TieLayout::Part& part) {
    return part.bends || !bodies.describe(part.body).loose.empty();
  };
  ties.floats = std::ranges::any_of(layout.parts, floats);
  for (const TieLayout::Member& member : layout.members) {
    if (member.carried >= 0) continue;
    const Side& side = member.joint->kinematic_side();
    const Description& body = bodies.describe(side.body);
    ties.joints.push_back({member.joint->name, body.name + "." + bodies.port(side).name,
                           body.step > 0.0 ? body.step : bodies.window(),
                           member.tie->rows().count()});
  }
  return ties;
}

/// Whether contact is on one of the bodies.
bool is_touched(const TieLayout& layout, std::span<const Joint> joints) {
  const auto touches = [&layout](const Side& side) {
    return std::ranges::any_of(
        layout.parts, [&side](const TieLayout::Part& part) { return part.body == side.body; });
  };
  return std::ranges::any_of(joints, [&touches](const Joint& joint) {
    return !joint.tied() && std::ranges::any_of(joint.sides, touches);
  });
}

}  // namespace

std::vector<Estimate::Ties> estimate_ties(const Scene& scene, std::vector<Joint>& joints,
                                          const Bodies& bodies) {
  const KnownExchanges known = known_exchanges(joints);
  std::vector<Tie*> tie_of(joints.size(), nullptr);
  for (const auto& [joint, tie, part] : known.ties) {
    joints[part].press();
    tie_of[part] = tie;
  }
  std::vector<Estimate::Ties> all;
  for (const Island& island : find_islands(joints, bodies.count())) {
    const bool ties =
        std::ranges::any_of(island.joints, [&tie_of](int j) { return tie_of[j] != nullptr; });
    if (!ties) continue;
    const TieLayout layout = layout_of(island, joints, tie_of, bodies, scene.time.window);
    all.push_back(ties_of(layout, tie_kernel_options(scene.schwarz), bodies));
    all.back().touched = is_touched(layout, joints);
  }
  return all;
}

}  // namespace abut
