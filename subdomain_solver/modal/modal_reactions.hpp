#pragma once

#include <memory>
#include <vector>

#include "subdomain_solver/modal/modal_map.hpp"
#include "subdomain_solver/reactions.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// Forces of the supports of a body in modes [M.74]: those of the whole mesh at rest under the
/// loads less the inertia of the modes. The stress of the modes alone would leave the loads that
/// they cannot follow out; this way reactions, loads and inertia are in balance however few modes.
class ModalReactions final : public Reactions {
 public:
  /// What moves the body and what acts on it; the references must outlive this. The loads are dead,
  /// on the mesh.
  struct Body {
    FeModel& mesh;
    const ModalMap& map;
    const Integrator& integrator;
    SparseMatrix mass;  // [kg] (dofs, dofs) of the mesh, of the scheme's form
    double step = 0.0;  // [s] of the scheme
    std::vector<std::unique_ptr<Load>> loads;
  };
  /// `supports` are dofs, sorted. Throws InputError, told of `where`, when the stiffness is
  /// singular beyond rigid motions.
  ModalReactions(Body body, const std::vector<int>& supports,
                 const std::vector<HeldCoordinates>& constraints, const std::string& where);
  void forces(const Motion& motion, double time, const Vector& on_ports, Vector& out) override;
  void sums(const Motion& motion, double time, const Vector& on_ports,
            std::vector<double>& out) override;

 private:
  const Vector& carried(const Motion& motion, double time, const Vector& on_ports);
  Vector at_rest(const Vector& force) const;

  Body body_;
  std::vector<int> supports_;
  SparseMatrix stiffness_;  // [N/m] (dofs, dofs)
  FreeCoordinates held_;    // less rigid motions that the supports allow
  std::unique_ptr<LinearSolver> solver_;
  Eigen::MatrixXd shapes_;  // (dofs, constraints x dim) of unit displacements of the constraints
  Vector external_, rates_, force_, sums_;
  std::vector<double> acceleration_;
};

}  // namespace abut
