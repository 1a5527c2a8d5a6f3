#pragma once

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// Whether this build has PETSc, which is an option for its size (docs/adr/0053-petsc.md).
bool has_petsc();

/// Conjugate gradients with algebraic multigrid by PETSc, for positive definite matrices; nullptr
/// in a build without it. `tolerance` is of the residual relative to the right-hand side. Where
/// several processes of mpirun run this program (join_processes) they share matrix and solve.
std::unique_ptr<LinearSolver> make_petsc_solver(double tolerance);

/// To be called before anything else. Where mpirun has started this program more than once, the
/// first process returns, and the others serve its solvers until it ends, and end then.
void join_processes(const char* program);

}  // namespace abut
