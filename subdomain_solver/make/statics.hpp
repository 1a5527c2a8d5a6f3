#pragma once

#include <vector>

#include <Eigen/Dense>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// Rigid motions that supports leave a body without inertia, as QuasiStatic::Options has them.
struct LooseMotions {
  Eigen::MatrixXd motions;  // (dofs, k)
  double stiffness = 0.0;   // [N/m] that stabilises them [M.143]; 0: what the body is tied to
  double most = 0.0;  // of all that presses on the body, that stabilisation may bear at the end
};

/// What else than its supports and its stiffness may hold a body.
struct OtherHold {
  bool joined = false;   // a port is tied to another body
  bool touched = false;  // a port may meet another body
};

/// Throws InputError where a body without inertia may move as a whole and nothing else could hold
/// it, or where it is to be stabilised and need not be.
LooseMotions check_statics(const BodySpec& spec, const Place& place, const FeModel& model,
                           const std::vector<Prescribed>& supports, OtherHold other);

}  // namespace abut
