#pragma once

#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/solve/lowest_modes.hpp"

namespace abut {

/// Shapes in which a linear body moves, u = Phi q, made free of each other: Phi^T M Phi = 1,
/// Phi^T K Phi = diag(omega^2).
struct ModalBasis {
  Eigen::MatrixXd shapes;  // Phi (nodal values, coordinates), in the nodes' own frames
  Vector frequencies;      // [rad/s] omega, ascending; exactly 0 of rigid motions
  int rigid = 0;           // number of rigid motions, which come first
  int port_coordinates = 0;
  int fixed_modes = 0;  // modes with fixed ports
};

/// Craig and Bampton's reduction (1968) of a linear model at rest, [M.55 to M.57]: the static
/// shapes of unit displacements of every port coordinate, the rigid motions, and the lowest modes
/// with fixed ports. `supports` and `ports` are dofs, sorted; those that are supported stay at
/// zero. `wanted` counts the modes with fixed ports, eigenvalues are squares of omega. Throws
/// InputError, told of `where`, when the stiffness is singular beyond rigid motions or there are
/// fewer modes than wanted.
ModalBasis reduce(FeModel& model, const std::vector<int>& supports, const std::vector<int>& ports,
                  MassForm mass, const WantedModes& wanted, const std::string& where);

}  // namespace abut
