#pragma once

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// Supernodal Cholesky factors of SuiteSparse, for positive definite matrices; nullptr when the
/// build was made without CHOLMOD, which is GPL and therefore an option.
std::unique_ptr<LinearSolver> make_cholmod_solver(Pivots pivots);

}  // namespace abut
