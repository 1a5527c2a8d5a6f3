#pragma once

#include <span>

#include <Eigen/Core>

#include "subdomain_solver/fe/element.hpp"

namespace abut {

/// Whether one point leaves fields without energy: hex8 and quad4.
bool has_hourglasses(const Element& element);

/// Stiffness [N/m] (nodes, nodes) of a one-point cell against its hourglass fields, the same for
/// every component of displacement [M.52] (Flanagan and Belytschko 1981). x: [m] (nodes, dim)
/// positions; b: [1/m] (nodes, dim) mean gradients; volume [m^3], thickness included; stiffness:
/// [Pa] coefficient x P-wave modulus. Linear fields have no force.
Eigen::MatrixXd hourglass_stiffness(const Element& element, const Eigen::MatrixXd& x,
                                    const Eigen::MatrixXd& b, double volume, double stiffness);

class FeModel;
/// [J] of all cells of a model in their hourglasses [M.52], a part of what it stores; u: [m]
/// (nodes, dim) along the axes of space. 0 under other formulations.
double hourglass_energy(const FeModel& model, std::span<const double> u);

}  // namespace abut
