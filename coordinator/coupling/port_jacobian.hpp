#pragma once

#include <vector>

#include <Eigen/Dense>

#include "contract/port.hpp"
#include "contract/substeps.hpp"

namespace abut {

/// [m/N] of a kernel of one pattern and value: what follows the force of the same instant.
inline double quasi_static(const PortKernel& kernel) {
  return kernel.compliance.empty() ? 0.0 : kernel.compliance.front();
}

/// Neumann map of one side: displacement along the push at the ends of its substeps 1..n for the
/// partner's contact forces 1..m of unit size, with forces spread in time exactly as the body does
/// it (n, m).
Eigen::MatrixXd neumann_map(const PortKernel& kernel, const Substeps& here, const Substeps& source,
                            ForceSupport source_support);

/// Interface Jacobian of the unilateral iteration, J = I + C_N R C_K^-1 P (n_N, n_N)  [M: port
/// kernel]: change of the residual, with minus sign, for a change of the iterate (the Neumann
/// side's motion).
Eigen::MatrixXd unilateral_jacobian(const PortKernel& kinematic, const Substeps& kinematic_grid,
                                    const PortKernel& neumann, const Substeps& neumann_grid);

/// The same when both bodies take the same substeps: J is a lower triangular Toeplitz matrix, given
/// by its first column (n).
std::vector<double> unilateral_jacobian_column(const PortKernel& kinematic,
                                               const PortKernel& neumann, int count);

/// The same where every substep decides for itself whether contact pushes: change of the Neumann
/// side's motion that makes forces and gaps complementary, substep by substep  [M.20].
/// `r` residual along x, `normal` outward of the Neumann side, `overlap` [m] and `force` [N] of the
/// kinematic side at the substeps of the last sweep (n).
Eigen::VectorXd solve_unilateral(const std::vector<double>& kinematic,
                                 const std::vector<double>& neumann, double normal,
                                 const Eigen::VectorXd& r, const Eigen::VectorXd& overlap,
                                 const Eigen::VectorXd& force);

/// What forces on the kinematic side's substeps do to an interface whose sides step unlike, at
/// those substeps.
struct ContactMaps {
  Eigen::MatrixXd overlap;  // [m/N] (n_K, n_K) overlap removed there
  Eigen::MatrixXd motion;   // [m/N] (n_N, n_K) motion of the Neumann side along the push
  Eigen::MatrixXd seen;     // (n_K, n_N) its motion, as the kinematic side's substeps see it
};
ContactMaps contact_maps(const PortKernel& kinematic, const Substeps& kinematic_grid,
                         const PortKernel& neumann, const Substeps& neumann_grid);

/// Change d of the contact forces f >= 0 that makes forces and gaps complementary  [M.20]:
///   0 <= f + d,   overlap - A d <= 0,   and one of both is zero at every substep.
/// A is lower triangular but for substeps of unlike length, so passes through time settle it. They
/// creep where a coarse Neumann side gives way to many kicks at once: to 1e-3 then, and the next
/// iteration goes on from there.
Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& a, const Eigen::VectorXd& overlap,
                                      const Eigen::VectorXd& force);

/// x with T x = r for the lower triangular Toeplitz matrix T of a first column.
Eigen::VectorXd solve_toeplitz(const std::vector<double>& column, const Eigen::VectorXd& r);

/// Jacobian of the parallel iteration on the contact force at the source grid's substeps (n, n):
/// overlap removed there per unit force.
Eigen::MatrixXd parallel_jacobian(const std::vector<const PortKernel*>& kernels,
                                  const std::vector<Substeps>& grids, const Substeps& source,
                                  ForceSupport source_support);

}  // namespace abut
