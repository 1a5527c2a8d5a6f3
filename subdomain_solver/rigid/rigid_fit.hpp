#pragma once

#include <span>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/rigid/rigid_map.hpp"

namespace abut {

/// The rigid motion that a nodal field (nodes, dim) of a mesh is, for initial fields of scenes.
/// `distance` is the largest difference at a node [m or m/s] from the motion found: a field that is
/// rigid has round-off there.
struct PoseFit {
  Pose pose;
  double distance = 0.0;
};
struct TwistFit {
  Twist twist;
  double distance = 0.0;
};

/// Of displacements [m], by the least sum of squares weighted by the nodes' masses (Horn 1987).
PoseFit fit_pose(const RigidModel& body, const FeModel& mesh, std::span<const double> displacement);
/// Of velocities [m/s] in a pose, by linear and angular momentum. `mass` is the mesh's mass matrix
/// of the body's form.
TwistFit fit_twist(const RigidModel& body, const FeModel& mesh, const SparseMatrix& mass,
                   const Pose& pose, std::span<const double> velocity);

}  // namespace abut
