#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/outcome.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "surface/sparse_rows.hpp"

namespace abut {

/// Nodes under a name: a port. With it may go points inside the body, whose measures are not told.
struct NamedNodes {
  std::string name;
  std::vector<std::int32_t> nodes;
  SparseRows inside = {};  // shape functions at these points, over all nodes
};

/// Names of what a solid tells of its state, in the order of solid_measures: displacement.x.min,
/// velocity.y.mean, stress.xx.mean, von_mises.max, nodal_stress.xx.max, energy.stored,
/// angular_momentum.z, and of every port its mean displacement, velocity and stress,
/// tip.displacement.x (docs/OUTPUT.md). Without stress where the body cannot deform.
std::vector<std::string> solid_measure_names(int dim, bool deforms,
                                             const std::vector<NamedNodes>& ports);

/// What a solid's measures are taken of.
struct SolidState {
  bool deforms = true;
  std::span<const double> q;     // [m] coordinates of the mesh's model
  std::span<const double> velocity;  // [m/s] (nodes, dim) along the axes of space, as below
  std::span<const double> history;
  Energy energy;
  const Vector& nodal_momentum;  // [kg m/s] (nodes, dim)
};

/// Their values. Means are over nodes (displacement, velocity; of ports also stress) and over the
/// reference volume (Cauchy stress [Pa]); angular momentum is about the origin of space
/// [kg m^2/s]. Not a number where the state is inadmissible.
std::vector<double> solid_measures(FeModel& model, const SolidState& state,
                                   const std::vector<NamedNodes>& ports);

/// Writes [kg m^2/s] about the origin of space, from displacements [m] and the nodes' momenta
/// [kg m/s] (nodes, dim); about the axis out of the plane in two dimensions, none in one.
void angular_momentum(const Mesh& mesh, std::span<const double> u, const Vector& nodal_momentum,
                      std::vector<double>& out);

/// Cauchy stress [Pa] from first Piola-Kirchhoff stress and deformation gradient; P itself where
/// the law is one of small strain.
Matrix3 cauchy_stress(const Material& material, const Matrix3& stress, const Matrix3& deformation);
double von_mises(const Matrix3& stress);

}  // namespace abut
