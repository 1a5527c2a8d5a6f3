#pragma once

#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

/// What is left of the sum of a body's moments of inertia where its surface has no mass [M.162]:
/// below 1, as mass comes to lie further inside. `whole`, `layered`: [kg] (dofs) with the surface's
/// mass on its nodes and inside. In two and three dimensions.
double inertia_left(const Mesh& mesh, const Vector& whole, const Vector& layered);

}  // namespace abut
