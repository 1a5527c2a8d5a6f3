#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/modal/modal_basis.hpp"
#include "subdomain_solver/modal/modal_map.hpp"
#include "subdomain_solver/modal/modal_model.hpp"
#include "tests/support/solid_runs.hpp"

namespace abut {

inline WantedModes lowest(int count) {
  WantedModes wanted;
  wanted.count = count;
  return wanted;
}

inline std::vector<int> dofs_of(const Mesh& mesh, const std::string& name) {
  std::vector<int> out;
  for (std::int32_t node : mesh.nodes_of(name)) {
    for (int i = 0; i < mesh.dim; ++i) out.push_back(node * mesh.dim + i);
  }
  return out;
}

/// A solid in modal coordinates: the same mesh, supports and loads. `port` names a side or a node
/// set, or is empty. The solid must outlive it.
struct ModalSolid {
  ModalSolid(Solid& solid, const std::string& port, MassForm form, const WantedModes& wanted)
      : fe(solid),
        basis(reduce(solid.model, supports(solid), ports(solid, port), form, wanted, "test")),
        model(basis.frequencies),
        map(basis.shapes),
        mass(mass_matrix(solid.model, form)) {
    problem.model = &model;
    motion.q = project(solid.motion.q);
    motion.v = project(solid.motion.v);
  }

  static std::vector<int> supports(const Solid& solid) {
    std::vector<int> out;
    for (const Prescribed& p : solid.problem.supports) out.push_back(p.dof);
    return out;
  }
  static std::vector<int> ports(const Solid& solid, const std::string& port) {
    return port.empty() ? std::vector<int>() : dofs_of(solid.model.mesh(), port);
  }

  /// The load acts here instead of on the solid's nodes.
  void take(std::unique_ptr<Load> load) {
    problem.loads.push_back(
        std::make_unique<LiftedLoad>(std::move(load), map, index(fe.model.dofs())));
  }
  /// Amplitudes of nodal values, in the mass.
  std::vector<double> project(const std::vector<double>& nodal) const {
    const Vector q = basis.shapes.transpose() * (mass * view(nodal));
    return {q.data(), q.data() + q.size()};
  }
  std::vector<double> nodal(const std::vector<double>& amplitudes) const {
    std::vector<double> out(index(fe.model.dofs()));
    map.displacement(amplitudes, out);
    return out;
  }

  Solid& fe;
  ModalBasis basis;
  ModalModel model;
  ModalMap map;
  SparseMatrix mass;
  Problem problem;
  Motion motion;
};

/// Forces on single coordinates, growing with time from zero.
class GrowingForces final : public Load {
 public:
  explicit GrowingForces(Vector force) : force_(std::move(force)) {}
  void add(double time, std::span<const double>, Vector& force) const override {
    force += time * force_;
  }

 private:
  Vector force_;
};

}  // namespace abut
