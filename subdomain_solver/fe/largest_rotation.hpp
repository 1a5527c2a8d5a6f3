#pragma once

#include <span>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Largest |1/2 curl u| [rad] at the centres of every `stride`-th cell, the rotation of laws that
/// are linear: they see no strain in it, but it lengthens a body by sqrt(1 + r^2). u: [m]
/// (nodes, dim) along the axes of space. 0 of bars.
double largest_rotation(const Mesh& mesh, std::span<const double> u, int stride = 1);

}  // namespace abut
