#pragma once

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// L D L^T by dense fronts in an order of nested dissection, without exchanges  (docs/adr/0035).
std::unique_ptr<LinearSolver> make_multifrontal_solver(Pivots pivots,
                                                       WorkerThreads* threads = nullptr);

}  // namespace abut
