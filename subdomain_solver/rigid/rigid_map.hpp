#pragma once

#include <vector>

#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/rigid/rigid_model.hpp"

namespace abut {

/// rigid: with r the arm of a node from the centre of mass before the body turns [M.60],
///   u = d + (R - 1) r,   v = V + w x R r,   f: force Σ f, moment Σ R r x f.
class RigidMap final : public NodalMap {
 public:
  RigidMap(const RigidModel& body, const Mesh& mesh);
  void displacement(std::span<const double> q, std::span<double> u) const override;
  void velocity(std::span<const double> q, std::span<const double> v,
                std::span<double> out) const override;
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::span<double> out) const override;
  void lift(std::span<const double> q, std::span<const double> nodal, Vector& force) const override;

 private:
  template <class Value>
  void fill(std::span<double> out, Value value) const;

  const RigidModel& body_;
  std::vector<Eigen::Vector3d> arms_;  // [m] (nodes)
};

}  // namespace abut
