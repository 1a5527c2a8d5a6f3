#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/make/solid_spec.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// How the linear equations of a solid are solved.
struct LinearChoice {
  std::function<std::unique_ptr<LinearSolver>(Pivots)> make;
  std::string words;  // for the line that tells the body; empty: by a direct solver
};

/// As the scene says; where it says nothing by a direct solver while factors fit into memory, which
/// a body of fewer dimensions than three always has room for, by conjugate gradients and multigrid
/// beyond. Where others touch the body or are joined to it, every coordinate of its ports takes a
/// solution: factors serve them all, and are kept up to twice as many unknowns. `held`: coordinates
/// that supports prescribe, ascending. The model must outlive what is made.
LinearChoice linear_choice(const EquationsSpec& spec, FeModel& model, const std::vector<int>& held,
                           const std::vector<SolidInterior::PortNodes>& ports);

/// The same of a model without a mesh, as one of modes.
LinearChoice linear_choice(const EquationsSpec& spec);

/// Rigid motions of the free coordinates of a mesh, and a uniform one of each direction that these
/// leave out (the radial one of a body of revolution).
CoarseMotions coarse_motions(const FeModel& model, const std::vector<int>& held);

}  // namespace abut
