#include "coordinator/coupling/sprung_sides.hpp"

#include <algorithm>

#include "coordinator/coupling/port_pose.hpp"
#include "surface/overlap_places.hpp"

namespace abut {

namespace {

/// Of the spacing of nodes: no spring.
constexpr double negligible = 1.0e-6;
/// The same: layers without mass spring by strains times their depth, which is less.
constexpr double spring_reach = 2.0;

bool moved(const Waveform& trace) {
  return std::ranges::any_of(trace.u, [](double u) { return u != 0.0; });
}

}  // namespace

bool sprang_together(const Joint& joint, const Bodies& bodies) {
  const auto [a, b] = joint.sides;
  if (bodies.port(a).geometry.dim == 1) return false;
  if (!moved(trace_of(bodies, a)) && !moved(trace_of(bodies, b))) return false;
  const double one = bodies.port(a).geometry.spacing, other = bodies.port(b).geometry.spacing;
  return !overlap_places(
              bodies.pose(a).surface(), bodies.pose(b).surface(),
              {{negligible * one, negligible * other}, spring_reach * std::max(one, other)})
              .empty();
}

}  // namespace abut
