#pragma once

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Kinematics of bodies in two dimensions; three need no choice.
enum class Plane { strain, stress, axisymmetric };

/// The entries of a tensor that vary in the plane, in the order 11, 21, 12, 22, 33 (the order of
/// the tangent). 33 is 1 in plane strain, the hoop stretch r/R in axisymmetry, and in plane stress
/// an inner unknown.
using PlaneEntries = Eigen::Matrix<double, 5, 1>;
using PlaneTangent = Eigen::Matrix<double, 5, 5>;

/// F of space from F of the plane and the stretch normal to it.
Matrix3 embed(const Eigen::Matrix2d& f, double normal = 1.0);
PlaneEntries in_plane(const Matrix3& tensor);
PlaneTangent in_plane(const Tangent& tangent);

}  // namespace abut
