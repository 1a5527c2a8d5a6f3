#include "coordinator/coupling/islands.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

namespace {

/// Bodies of an island by level: a body comes after the kinematic partners whose reactions it
/// takes.
std::vector<std::vector<int>> levels_of(const std::vector<int>& members,
                                        std::span<const Joint> joints,
                                        const std::vector<int>& island) {
  std::vector<int> waiting = members;
  std::vector<int> done;
  std::vector<std::vector<int>> levels;
  auto is_done = [&done](int body) {
    return std::find(done.begin(), done.end(), body) != done.end();
  };
  while (!waiting.empty()) {
    std::vector<int> level;
    for (int body : waiting) {
      const bool ready =
          std::all_of(island.begin(), island.end(), [&joints, body, &is_done](int j) {
            const Joint& joint = joints[index(j)];
            return joint.neumann_side().body != body || !joint.how->ordered() ||
                   is_done(joint.kinematic_side().body);
          });
      if (ready) level.push_back(body);
    }
    if (level.empty()) {
      throw RunError("the kinematic sides of closed interfaces go round in a circle", "interfaces",
                     "Leave `kinematic: auto` on at least one interface of the circle.");
    }
    for (int body : level) {
      done.push_back(body);
      waiting.erase(std::find(waiting.begin(), waiting.end(), body));
    }
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace

std::vector<Island> find_islands(std::span<const Joint> joints, int bodies) {
  std::vector<int> root(index(bodies));
  for (int b = 0; b < bodies; ++b) root[index(b)] = b;
  auto merge = [&root](int from, int to) {
    for (int& r : root) {
      if (r == from) r = to;
    }
  };
  for (const Joint& joint : joints) {
    if (!joint.closed()) continue;
    const int a = root[index(joint.sides[0].body)];
    const int b = root[index(joint.sides[1].body)];
    merge(std::max(a, b), std::min(a, b));
  }
  std::vector<Island> islands;
  for (int r = 0; r < bodies; ++r) {
    Island island;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].closed() && root[index(joints[j].sides[0].body)] == r)
        island.joints.push_back(static_cast<int>(j));
    }
    if (island.joints.empty()) continue;
    std::vector<int> members;
    for (int b = 0; b < bodies; ++b) {
      if (root[index(b)] == r) members.push_back(b);
    }
    island.levels = levels_of(members, joints, island.joints);
    islands.push_back(std::move(island));
  }
  return islands;
}

void Partition::update(std::span<const Joint> joints, int bodies) {
  bool same = roles_.size() == joints.size() && !(islands_.empty() && free_.empty());
  roles_.resize(joints.size(), -1);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int role = joints[j].closed() ? joints[j].kinematic : -1;
    same = same && roles_[j] == role;
    roles_[j] = role;
  }
  if (same) return;
  islands_ = find_islands(joints, bodies);
  free_.resize(index(bodies));
  std::iota(free_.begin(), free_.end(), 0);
  for (const Island& island : islands_) {
    for (const std::vector<int>& level : island.levels) {
      for (int body : level) std::erase(free_, body);
    }
  }
}

}  // namespace abut
