#pragma once

#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/reactions.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// Prescribed coordinates, sorted, the frames that inclined ones need, and what is held by which
/// constraint: the scene's, and in one dimension `left` and `right` of its supports.
struct Constraints {
  std::vector<Prescribed> supports;
  std::vector<NodeFrame> frames;
  std::vector<HeldCoordinates> held;
};

/// A symmetry in terms of its direction: a component where the side lies along axes, which may
/// share nodes with others. Throws InputError, told of nothing, where the side is not plane.
ConstraintSpec mirrored(const Mesh& mesh, ConstraintSpec spec);

/// What a scene's constraints prescribe on a mesh. Throws InputError.
Constraints make_constraints(const BodySpec& spec, const Place& place, const Mesh& mesh);

}  // namespace abut
