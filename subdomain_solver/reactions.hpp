#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Coordinates of the mesh's model that a constraint holds, under its name. One that two
/// constraints hold belongs to the first of them, so that sums over constraints count it once.
struct HeldCoordinates {
  std::string name;
  std::vector<int> dofs;
};

/// Forces of the supports on a body [M.71]: what inertia and internal forces take beyond the loads.
class Reactions {
 public:
  virtual ~Reactions() = default;
  /// [N] (dofs of the mesh) in the nodes' own frames, zero where nothing is held, at a time [s] of
  /// the motion. `on_ports`: forces on ports then, [N] (dofs of the mesh) alike.
  virtual void forces(const Motion& motion, double time, const Vector& on_ports, Vector& out) = 0;
  /// Their sum for every constraint, [N] (constraints, dim) along the axes of space. Bodies of
  /// revolution: over the whole circumference, radial forces added as if they had one direction.
  /// Records ask for them: nothing is allocated once buffers have grown.
  virtual void sums(const Motion& motion, double time, const Vector& on_ports,
                    std::vector<double>& out) = 0;
};

/// Those of a body whose coordinates are its nodes' displacements.
class NodalReactions final : public Reactions {
 public:
  /// The mass is of the scheme's form, the step [s] the scheme's; what is referred to must outlive
  /// this. Loads that the problem has by now are the body's own, later ones are of its ports.
  NodalReactions(const FeModel& model, const Problem& problem, const Integrator& integrator,
                 const SparseMatrix& mass, double step, std::vector<HeldCoordinates> constraints);
  void forces(const Motion& motion, double time, const Vector& on_ports, Vector& out) override;
  void sums(const Motion& motion, double time, const Vector& on_ports,
            std::vector<double>& out) override;

 private:
  const FeModel& model_;
  const Problem& problem_;
  const Integrator& integrator_;
  SparseMatrix mass_;  // (supports, dofs)
  std::size_t own_loads_;
  double step_;
  std::vector<HeldCoordinates> constraints_;
  Vector acceleration_, inertia_, external_, forces_;
};

/// Direction in space of a coordinate of the mesh's model.
Eigen::Vector3d direction_of(const FeModel& model, int dof);

/// Sums of [N] (dofs) for every constraint, [N] (constraints, dim) along the axes of space.
void sum_reactions(const FeModel& model, const std::vector<HeldCoordinates>& constraints,
                   const Eigen::Ref<const Vector>& forces, std::vector<double>& out);

/// Names of the sums as columns of a history, with their unit: "clamp.reaction_x [N]".
std::vector<std::string> reaction_columns(int dim, const std::vector<HeldCoordinates>& constraints);
/// Names as measures, and at last of the sum over all constraints: "clamp.reaction.x",
/// "reaction.x". Empty without constraints.
std::vector<std::string> reaction_measure_names(int dim,
                                                const std::vector<HeldCoordinates>& constraints);
/// Their values from the sums.
std::vector<double> reaction_measures(int dim, const std::vector<double>& sums);

}  // namespace abut
