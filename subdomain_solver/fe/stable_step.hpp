#pragma once

#include <span>

#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// [s] Step below which central differences are stable for the tangent at given coordinates and
/// history: 2/omega with a bound on the highest frequency, the largest of all cells alone with
/// their shares of the lumped mass [M.53]. Sharp on uniform meshes; below the true limit by what
/// neighbours of a stiff or light cell add. Infinite where nothing is stiff. NaN: inadmissible.
/// Cells of equal shape and displacement are computed once; each other one costs an eigenvalue
/// problem of its size.
double stable_step(FeModel& model, std::span<const double> q, std::span<const double> history);

/// The same at rest.
double stable_step(FeModel& model);

/// Largest eigenvalue of M^-1 K, [1/s^2] for a stiffness [N/m] (nodes x dim) and one mass [kg] per
/// node.
double highest_square(Eigen::MatrixXd stiffness, const Vector& mass);
}  // namespace abut
