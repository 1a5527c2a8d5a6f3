#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/index.hpp"
#include "subdomain_solver/fe/loads.hpp"
#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/motion_views.hpp"
#include "subdomain_solver/time/quasi_static.hpp"
#include "tests/support/solids.hpp"

namespace abut {

using Position = Eigen::Vector3d;
using Displaced = std::function<Position(const Position&)>;

/// Reference position of a node; zeros beyond the mesh's dimension.
inline Position position(const Mesh& mesh, int node) {
  Position x = Position::Zero();
  for (int i = 0; i < mesh.dim; ++i) x(i) = mesh.points[node * mesh.dim + i];
  return x;
}

/// Nodal values (nodes, dim) of a vector field.
inline std::vector<double> nodal(const Mesh& mesh, const Displaced& field) {
  std::vector<double> out(mesh.points.size());
  for (int node = 0; node < mesh.node_count(); ++node) {
    const Position value = field(position(mesh, node));
    for (int i = 0; i < mesh.dim; ++i) out[node * mesh.dim + i] = value(i);
  }
  return out;
}

/// Moves the nodes of a mesh.
inline void move(Mesh& mesh, const Displaced& to) { mesh.points = nodal(mesh, to); }

inline Moduli isotropic(double youngs_modulus, double poissons_ratio) {
  ElasticConstants constants;
  constants.youngs_modulus = youngs_modulus;
  constants.poissons_ratio = poissons_ratio;
  return moduli_of(constants);
}

/// A model with its supports and loads, and what runs make of it.
struct Solid {
  explicit Solid(Mesh mesh, std::unique_ptr<const Material> law, const FeOptions& options = {},
                 const std::vector<NodeFrame>& frames = {})
      : model(std::move(mesh), std::move(law), options, frames) {
    problem.model = &model;
    motion.q.assign(index(model.dofs()), 0.0);
    motion.v = motion.q;
  }

  /// Prescribes one component on the nodes of a side or node set, once per coordinate.
  void prescribe(const std::string& name, int component,
                 const std::function<double(const Position&, double)>& value) {
    for (std::int32_t node : model.mesh().nodes_of(name)) prescribe_node(node, component, value);
  }
  void prescribe_node(std::int32_t node, int component,
                      const std::function<double(const Position&, double)>& value) {
    const int dof = node * model.mesh().dim + component;
    auto at = std::lower_bound(problem.supports.begin(), problem.supports.end(), dof,
                               [](const Prescribed& p, int d) { return p.dof < d; });
    if (at != problem.supports.end() && at->dof == dof) return;
    const Position x = position(model.mesh(), node);
    problem.supports.insert(at, {dof, [x, value](double time) { return value(x, time); }});
  }
  void fix(const std::string& name, int component) {
    prescribe(name, component, [](const Position&, double) { return 0.0; });
  }
  void pull(const std::string& side, VectorField traction) {
    problem.loads.push_back(std::make_unique<Traction>(model, side, std::move(traction)));
  }
  void press(const std::string& side, ScalarField pressure, bool follows) {
    problem.loads.push_back(std::make_unique<Pressure>(model, side, std::move(pressure), follows));
  }

  /// Equilibrium at time 1, by equal steps from time 0.
  void settle(int steps = 1, const NewtonOptions& newton = {}) {
    QuasiStatic run(problem, {newton, 8}, make_direct_solver());
    const std::optional<Failed> refused = run.begin(motion, 0.0);
    ASSERT_FALSE(refused) << refused->detail;
    for (int k = 0; k < steps; ++k) {
      const std::optional<Failed> failed = run.step(motion, double(k) / steps, 1.0 / steps);
      ASSERT_FALSE(failed) << failed->detail;
    }
    iterations = run.iterations();
  }

  /// Displacement of a node.
  Position displacement(int node) const {
    Position u = Position::Zero();
    for (int i = 0; i < model.mesh().dim; ++i) u(i) = motion.q[node * model.mesh().dim + i];
    return u;
  }
  /// Mean over the nodes of a side or node set.
  Position mean_displacement(const std::string& name) const {
    Position sum = Position::Zero();
    const std::vector<std::int32_t> nodes = model.mesh().nodes_of(name);
    for (std::int32_t node : nodes) sum += displacement(node);
    return sum / static_cast<double>(nodes.size());
  }

  FeModel model;
  Problem problem;
  Motion motion;
  int iterations = 0;
};

}  // namespace abut
