#include "subdomain_solver/nodal_map.hpp"

#include <algorithm>

namespace abut {

void IdentityMap::displacement(std::span<const double> q, std::span<double> u) const {
  std::copy(q.begin(), q.end(), u.begin());
}

void IdentityMap::velocity(std::span<const double>, std::span<const double> v,
                           std::span<double> out) const {
  std::copy(v.begin(), v.end(), out.begin());
}

void IdentityMap::acceleration(std::span<const double>, std::span<const double>,
                               std::span<const double> a, std::span<double> out) const {
  std::copy(a.begin(), a.end(), out.begin());
}

void IdentityMap::lift(std::span<const double>, std::span<const double> nodal,
                       Vector& force) const {
  force += Eigen::Map<const Vector>(nodal.data(), static_cast<Eigen::Index>(nodal.size()));
}

LiftedLoad::LiftedLoad(std::unique_ptr<const Load> load, const NodalMap& map, std::size_t nodal)
    : load_(std::move(load)), map_(map), nodal_(nodal) {}

void LiftedLoad::add(double time, std::span<const double> q, Vector& force) const {
  std::vector<double> u;
  if (load_->follows()) {
    u.resize(nodal_);
    map_.displacement(q, u);
  }
  Vector on_nodes = Vector::Zero(static_cast<Eigen::Index>(nodal_));
  load_->add(time, u, on_nodes);
  map_.lift(q, {on_nodes.data(), nodal_}, force);
}

}  // namespace abut
