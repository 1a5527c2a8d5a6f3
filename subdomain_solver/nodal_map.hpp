#pragma once

#include <memory>
#include <span>
#include <vector>

#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// How a body's coordinates q move the nodes of its mesh [M.54]: the rungs of the fidelity ladder
/// differ in it. fe: q are the nodal displacements; a reduced rung: u = u(q). All nodal values are
/// (nodes, dim), in the nodes' own frames where they have one (FeModel::to_space).
class NodalMap {
 public:
  virtual ~NodalMap() = default;
  virtual void displacement(std::span<const double> q, std::span<double> u) const = 0;  // [m]
  /// [m/s] from coordinates and their rates.
  virtual void velocity(std::span<const double> q, std::span<const double> v,
                        std::span<double> out) const = 0;
  /// [m/s^2]
  virtual void acceleration(std::span<const double> q, std::span<const double> v,
                            std::span<const double> a, std::span<double> out) const = 0;
  /// Adds the generalised force P(q)^T f of nodal forces f [N], P = du/dq.
  virtual void lift(std::span<const double> q, std::span<const double> nodal,
                    Vector& force) const = 0;

  /// The map to a few of its nodal values, in the order of the list, for those who look at ports in
  /// every step. By default it goes by way of all `nodal` values. It refers to this map.
  virtual std::unique_ptr<NodalMap> on(const std::vector<int>& values, std::size_t nodal) const;
};

/// fe: the coordinates are the nodal displacements.
class IdentityMap final : public NodalMap {
 public:
  void displacement(std::span<const double> q, std::span<double> u) const override;
  void velocity(std::span<const double> q, std::span<const double> v,
                std::span<double> out) const override;
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::span<double> out) const override;
  void lift(std::span<const double> q, std::span<const double> nodal, Vector& force) const override;
  std::unique_ptr<NodalMap> on(const std::vector<int>& values, std::size_t nodal) const override;
};

/// A load on the mesh as the coordinates of a reduced rung see it. Its stiffness does not join a
/// tangent.
class LiftedLoad final : public Load {
 public:
  /// `nodal` is the number of nodal values, nodes x dim. The map must outlive the load.
  LiftedLoad(std::unique_ptr<const Load> load, const NodalMap& map, std::size_t nodal);
  void add(double time, std::span<const double> q, Vector& force) const override;

 private:
  std::unique_ptr<const Load> load_;
  const NodalMap& map_;
  std::size_t nodal_;
  mutable std::vector<double> u_;
  mutable Vector on_nodes_;
};

}  // namespace abut
