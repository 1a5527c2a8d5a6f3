#include "coordinator/coupling/nearness.hpp"

#include <algorithm>
#include <cmath>

#include "coordinator/coupling/port_pose.hpp"
#include "surface/least_distance.hpp"

namespace abut {

namespace {

/// Of the extent of the smaller side: boxes farther apart than this tell the distance well enough.
constexpr double far_share = 0.5;
/// Of the largest coordinate: what places, distances and ways are rounded by altogether is far
/// less, and what bodies do to each other is of windows that are far longer.
constexpr double distance_rounding = 1.0e-12;
/// Of a facet's size: what overlaps by less at the start does so by roundings of its places, and
/// is apart by that on the wrong sides.
constexpr double touching = 1.0e-6;

/// Of the way that is foreseen: sides that are nearer than this may meet.
constexpr double foreseen_ways = 1.5;

struct Boxes {
  double apart = 0.0;   // [m]
  double extent = 0.0;  // [m] longest side of the smaller one
};

/// The boxes in which the sides ended their last replies.
Boxes last_boxes(const Joint& joint, const Bodies& bodies) {
  const PortResponse& a = port_of(bodies, joint.sides[0]);
  const PortResponse& b = port_of(bodies, joint.sides[1]);
  const std::size_t dim = index(bodies.port(joint.sides[0]).geometry.dim);
  const std::size_t last_a = a.lower.size() - dim, last_b = b.lower.size() - dim;
  double square = 0.0, extent_a = 0.0, extent_b = 0.0;
  for (std::size_t i = 0; i < dim; ++i) {
    const double apart = std::max(a.lower[last_a + i] - b.upper[last_b + i],
                                  b.lower[last_b + i] - a.upper[last_a + i]);
    if (apart > 0.0) square += apart * apart;
    extent_a = std::max(extent_a, a.upper[last_a + i] - a.lower[last_a + i]);
    extent_b = std::max(extent_b, b.upper[last_b + i] - b.lower[last_b + i]);
  }
  return {std::sqrt(square), std::min(extent_a, extent_b)};
}

double distance(const Joint& joint, const Bodies& bodies) {
  const Boxes boxes = last_boxes(joint, bodies);
  if (boxes.apart > far_share * boxes.extent) return boxes.apart;
  const PortPose &a = bodies.pose(joint.sides[0]), &b = bodies.pose(joint.sides[1]);
  return least_distance(a.surface(), a.tree(), b.surface(), b.tree());
}

/// Of what the sides have in common nothing closes the gap; what a body foresees beyond the
/// velocities that its points had comes on top.
double closing_bound(const Joint& joint, const Bodies& bodies) {
  double absolute = 0.0, foreseen = 0.0;
  for (const Side& side : joint.sides) {
    const double bound = port_of(bodies, side).speed_bound;
    if (std::isinf(bound)) return bound;
    const PortPose& pose = bodies.pose(side);
    absolute += bound;
    foreseen += std::max(0.0, bound - pose.velocity().norm() - pose.spread()) + pose.spread();
  }
  const PortPose &a = bodies.pose(joint.sides[0]), &b = bodies.pose(joint.sides[1]);
  return std::min(absolute, (a.velocity() - b.velocity()).norm() + foreseen);
}

/// [m/s] Of the points of both sides at all times of the last replies.
double seen_closing(const Joint& joint, const Bodies& bodies) {
  const PortPose &a = bodies.pose(joint.sides[0]), &b = bodies.pose(joint.sides[1]);
  return (a.velocity() - b.velocity()).norm() + a.spread() + b.spread();
}

/// [m/s] Of two boxes of velocities, the largest difference.
double difference(const PortResponse& a, const PortResponse& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < a.slowest.size(); ++i) {
    const double most = std::max(a.fastest[i] - b.slowest[i], b.fastest[i] - a.slowest[i]);
    square += most * most;
  }
  return std::sqrt(square);
}

/// [m/s] No point of a side was faster.
double fastest(const PortResponse& reply) {
  double square = 0.0;
  for (std::size_t i = 0; i < reply.slowest.size(); ++i) {
    const double most = std::max(-reply.slowest[i], reply.fastest[i]);
    square += most * most;
  }
  return reply.slowest.empty() ? reply.speed_bound : std::sqrt(square);
}

/// [m/s] No two points of the sides came together faster at any time of the last replies.
double fastest_closing(const Joint& joint, const Bodies& bodies, const Approach& before,
                       const Approach& now) {
  const PortResponse& a = port_of(bodies, joint.sides[0]);
  const PortResponse& b = port_of(bodies, joint.sides[1]);
  if (!a.slowest.empty() && !b.slowest.empty()) return difference(a, b);
  return std::max({fastest(a) + fastest(b), before.speed, now.speed});
}

double largest_coordinate(const PortResponse& reply) {
  double most = 0.0;
  for (const std::vector<double>* corner : {&reply.lower, &reply.upper})
    for (const double x : *corner) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

Approach approach_of(const Joint& joint, double margin, const Bodies& bodies) {
  return {std::max(0.0, distance(joint, bodies) - margin), closing_bound(joint, bodies)};
}

bool may_meet(const Joint& joint, const Bodies& bodies, double length) {
  return distance(joint, bodies) <= foreseen_ways * seen_closing(joint, bodies) * length;
}

bool swept_apart(const Joint& joint, double margin, const Bodies& bodies) {
  const PortResponse& a = port_of(bodies, joint.sides[0]);
  const PortResponse& b = port_of(bodies, joint.sides[1]);
  const std::size_t dim = index(bodies.port(joint.sides[0]).geometry.dim);
  const std::size_t values = std::min(a.lower.size(), b.lower.size());
  for (std::size_t part = 0; part < values; part += dim) {
    bool apart = false;
    for (std::size_t i = part; i < part + dim; ++i)
      apart = apart || a.lower[i] > b.upper[i] + margin || b.lower[i] > a.upper[i] + margin;
    if (!apart) return false;
  }
  return true;
}

bool kept_apart(const Joint& joint, const Approach& before, double margin, const Bodies& bodies,
                double length) {
  const double facet = std::max(bodies.port(joint.sides[0]).geometry.spacing,
                                bodies.port(joint.sides[1]).geometry.spacing);
  const bool touched = before.apart <= touching * facet;
  if (swept_apart(joint, touched ? margin + touching * facet : margin, bodies)) return true;
  const Approach now = approach_of(joint, margin, bodies);
  const double rounded =
      distance_rounding * std::max(largest_coordinate(port_of(bodies, joint.sides[0])),
                                   largest_coordinate(port_of(bodies, joint.sides[1])));
  const double apart = touched ? now.apart - before.apart : now.apart + before.apart;
  return apart > length * fastest_closing(joint, bodies, before, now) + rounded;
}

}  // namespace abut
