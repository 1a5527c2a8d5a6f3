#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// Two ports of different bodies, side 0 the first of them in the order of sweeps.
using PortPair = std::array<Side, 2>;

/// Of all pairs of surfaces of a scene where everything may touch everything, those few that are
/// near: found by their boxes, sorted along the longest axis and swept (Baraff 1992). Pairs that
/// are joined are not told again, nor those of two bodies that nothing moves.
class BroadPhase {
 public:
  /// No pairs: a scene whose interfaces are written one by one.
  BroadPhase() = default;
  /// All surfaces of all bodies; `joined`: pairs that the scene writes.
  BroadPhase(const Bodies& bodies, std::span<const Joint> joined);

  bool empty() const { return ports_.empty(); }
  /// Flat ones for instance, which may have passed each other.
  bool has_open_surfaces() const {
    return std::ranges::any_of(ports_, [](const Surface& port) { return port.open > 0.0; });
  }
  void join(const PortPair& pair);

  // Pairs are told in the order of their ports.

  /// Whose boxes overlap in the reference configuration, those of surfaces that are not closed
  /// larger by a hundredth of the smallest facet's width: flat ones have boxes without height, and
  /// may have passed each other there. `near` tells of all of these, whatever their boxes are then.
  std::vector<PortPair> near_at_start(const Bodies& bodies);
  /// That may come together within `time` [s] from the end of the last replies.
  std::vector<PortPair> near(const Bodies& bodies, double time);
  /// Whose boxes, as the last replies swept them, overlap.
  std::vector<PortPair> crossed(const Bodies& bodies);
  /// Most of `most` times `length` [s], halved as often as it takes, in which no pair can meet.
  int free_windows(const Bodies& bodies, double length, int most);

 private:
  struct Surface {
    Side side;
    bool stands = false;  // nothing that touches it moves it
    int rank = 0;         // of its body in the order of sweeps
    int whole = 0;        // of what ties hold together
    double open = 0.0;    // [m] width of a facet, where it is not closed
  };
  using Places = std::pair<int, int>;  // in ports_, ascending
  std::vector<Places> boxes_that_overlap() const;
  std::vector<PortPair> overlapping() const;

  std::vector<Surface> ports_;
  std::set<Places> joined_;
  std::vector<std::vector<int>> place_;  // in ports_, by body and port; -1: no surface
  double margin_ = 0.0;                  // [m] by which rows of any pair may press early
  std::vector<Box> boxes_;
  std::vector<Places> passed_;  // of the start, whose boxes had to be larger
};

}  // namespace abut
