#include "coordinator/coupling/islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "contract/no_answer.hpp"
#include "coordinator/coupling/exchange.hpp"

namespace abut {

namespace {

/// Bodies that hang together, each set under its smallest index (union by index with halved paths).
class Sets {
 public:
  explicit Sets(int bodies) : parent_(index(bodies)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int body) {
    while (parent_[body] != body) {
      parent_[body] = parent_[parent_[body]];
      body = parent_[body];
    }
    return body;
  }
  void merge(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Bodies of an island by level: a body comes after the kinematic partners whose reactions it
/// takes.
std::vector<std::vector<int>> levels_of(const std::vector<int>& members,
                                        std::span<const Joint> joints,
                                        const std::vector<int>& island,
                                        std::vector<int>& waits_for) {
  std::vector<std::vector<int>> levels(1);
  for (const int j : island) {
    const Joint& joint = joints[j];
    if (joint.exchange->ordered()) ++waits_for[joint.neumann_side().body];
  }
  for (const int body : members)
    if (waits_for[body] == 0) levels[0].push_back(body);
  std::size_t placed = levels[0].size();
  while (placed < members.size()) {
    std::vector<int> next;
    for (const int j : island) {
      const Joint& joint = joints[j];
      if (!joint.exchange->ordered()) continue;
      if (!std::ranges::binary_search(levels.back(), joint.kinematic_side().body)) continue;
      const int body = joint.neumann_side().body;
      if (--waits_for[body] == 0) next.push_back(body);
    }
    if (next.empty()) {
      throw NoAnswer("the kinematic sides of closed interfaces go round in a circle", "interfaces",
                     "Leave `kinematic: auto` on at least one interface of the circle.");
    }
    std::ranges::sort(next);
    placed += next.size();
    levels.push_back(std::move(next));
  }
  return levels;
}

/// Ends of an island's joints by the level of their bodies.
std::vector<std::vector<Island::End>> ends_of(const Island& island, std::span<const Joint> joints,
                                              std::vector<int>& level_of) {
  for (std::size_t l = 0; l < island.levels.size(); ++l)
    for (const int body : island.levels[l]) level_of[body] = static_cast<int>(l);
  std::vector<std::vector<Island::End>> ends(island.levels.size());
  for (std::size_t i = 0; i < island.joints.size(); ++i)
    for (const int side : {0, 1}) {
      const int body = joints[island.joints[i]].sides[side].body;
      ends[level_of[body]].push_back({i, side});
    }
  return ends;
}

/// Bodies that more than one joint of an island has.
std::vector<int> shared_of(const Island& island, std::span<const Joint> joints) {
  std::vector<int> ends, shared;
  for (const int j : island.joints)
    for (const Side& side : joints[j].sides) ends.push_back(side.body);
  std::ranges::sort(ends);
  for (std::size_t k = 1; k < ends.size(); ++k)
    if (ends[k] == ends[k - 1] && (shared.empty() || shared.back() != ends[k]))
      shared.push_back(ends[k]);
  return shared;
}

}  // namespace

std::vector<Island> find_islands(std::span<const Joint> joints, int bodies) {
  Sets sets(bodies);
  for (const Joint& joint : joints)
    if (joint.closed()) sets.merge(joint.sides[0].body, joint.sides[1].body);
  std::vector<Island> of_root(index(bodies));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!joints[j].closed()) continue;
    of_root[sets.root(joints[j].sides[0].body)].joints.push_back(static_cast<int>(j));
  }
  std::vector<std::vector<int>> members(index(bodies));
  for (int b = 0; b < bodies; ++b) members[sets.root(b)].push_back(b);
  std::vector<int> waits_for(index(bodies), 0), level_of(index(bodies), 0);
  std::vector<Island> islands;
  for (int r = 0; r < bodies; ++r) {
    Island& island = of_root[r];
    if (island.joints.empty()) continue;
    island.levels = levels_of(members[r], joints, island.joints, waits_for);
    island.ends = ends_of(island, joints, level_of);
    island.shared = shared_of(island, joints);
    islands.push_back(std::move(island));
  }
  return islands;
}

bool contacts_apart(const Island& island, std::span<const Joint> joints, const Bodies& bodies) {
  const auto moves = [&bodies](const Side& side) {
    return !std::isinf(bodies.describe(side.body).mass);
  };
  Sets sets(bodies.count());
  for (const int j : island.joints) {
    const std::array<Side, 2>& sides = joints[j].sides;
    for (const Side& side : sides)
      if (moves(side) && !bodies.describe(side.body).linear) return false;
    if (moves(sides[0]) && moves(sides[1])) sets.merge(sides[0].body, sides[1].body);
  }
  std::vector<int> contacts(index(bodies.count()), 0);
  for (const int j : island.joints) {
    const Joint& joint = joints[j];
    const Side& side = moves(joint.sides[0]) ? joint.sides[0] : joint.sides[1];
    if (!joint.tied() && moves(side) && ++contacts[sets.root(side.body)] > 1) return false;
  }
  return true;
}

bool Partition::update(std::span<const Joint> joints, int bodies) {
  bool same = roles_.size() == joints.size() && !(islands_.empty() && free_.empty());
  roles_.resize(joints.size(), -1);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int role = joints[j].closed() ? joints[j].role.kinematic : -1;
    same = same && roles_[j] == role;
    roles_[j] = role;
  }
  if (same) return false;
  islands_ = find_islands(joints, bodies);
  std::vector<bool> taken(index(bodies), false);
  for (const Island& island : islands_)
    for (const std::vector<int>& level : island.levels)
      for (const int body : level) taken[body] = true;
  free_.clear();
  for (int b = 0; b < bodies; ++b)
    if (!taken[b]) free_.push_back(b);
  return true;
}

}  // namespace abut
