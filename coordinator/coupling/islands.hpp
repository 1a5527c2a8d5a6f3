#pragma once

#include <span>
#include <vector>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Closed joints that hang together, and their bodies: what is iterated together.
struct Island {
  std::vector<int> joints;               // indices into the run's joints
  std::vector<std::vector<int>> levels;  // bodies; those of one level advance at once
  struct End {                           // of a joint
    std::size_t joint = 0;               // of `joints`
    int side = 0;
  };
  std::vector<int> shared;             // bodies of several of the joints, ascending
  std::vector<std::vector<End>> ends;  // by level: those of its bodies, in the order of the joints
};

/// Finds the islands of the closed joints and the order of sweeps inside them: kinematic sides
/// first. Throws NoAnswer when the roles go round in a circle, which Roles rules out.
std::vector<Island> find_islands(std::span<const Joint> joints, int bodies);

/// Whether no two contacts of an island reach each other through bodies that may move, all of which
/// are linear.
bool contacts_apart(const Island& island, std::span<const Joint> joints, const Bodies& bodies);

/// The bodies of a run by their closed joints; found again only when those change.
class Partition {
 public:
  /// True: the islands have changed.
  bool update(std::span<const Joint> joints, int bodies);

  const std::vector<Island>& islands() const { return islands_; }
  const std::vector<int>& free() const { return free_; }  // bodies in no island

 private:
  std::vector<int> roles_;  // by joint: kinematic side, or -1 when open
  std::vector<Island> islands_;
  std::vector<int> free_;
};

}  // namespace abut
