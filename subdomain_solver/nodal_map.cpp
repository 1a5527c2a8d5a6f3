#include "subdomain_solver/nodal_map.hpp"

#include <algorithm>

namespace abut {

namespace {

/// Of any map, by way of all its values.
class SomeValues final : public NodalMap {
 public:
  SomeValues(const NodalMap& whole, std::vector<int> values, std::size_t nodal)
      : whole_(whole), values_(std::move(values)), all_(nodal) {}

  void displacement(std::span<const double> q, std::span<double> u) const override {
    whole_.displacement(q, all_);
    pick(u);
  }
  void velocity(std::span<const double> q, std::span<const double> v,
                std::span<double> out) const override {
    whole_.velocity(q, v, all_);
    pick(out);
  }
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::span<double> out) const override {
    whole_.acceleration(q, v, a, all_);
    pick(out);
  }
  void lift(std::span<const double> q, std::span<const double> nodal,
            Vector& force) const override {
    std::fill(all_.begin(), all_.end(), 0.0);
    for (std::size_t k = 0; k < values_.size(); ++k) all_[values_[k]] += nodal[k];
    whole_.lift(q, all_, force);
  }

 private:
  void pick(std::span<double> out) const {
    for (std::size_t k = 0; k < values_.size(); ++k) out[k] = all_[values_[k]];
  }

  const NodalMap& whole_;
  std::vector<int> values_;
  mutable std::vector<double> all_;
};

/// The coordinates of a list.
class SomeCoordinates final : public NodalMap {
 public:
  explicit SomeCoordinates(std::vector<int> list) : list_(std::move(list)) {}

  void displacement(std::span<const double> q, std::span<double> u) const override {
    for (std::size_t k = 0; k < list_.size(); ++k) u[k] = q[list_[k]];
  }
  void velocity(std::span<const double>, std::span<const double> v,
                std::span<double> out) const override {
    displacement(v, out);
  }
  void acceleration(std::span<const double>, std::span<const double>, std::span<const double> a,
                    std::span<double> out) const override {
    displacement(a, out);
  }
  void lift(std::span<const double>, std::span<const double> nodal, Vector& force) const override {
    for (std::size_t k = 0; k < list_.size(); ++k) force(list_[k]) += nodal[k];
  }

 private:
  std::vector<int> list_;
};

}  // namespace

std::unique_ptr<NodalMap> NodalMap::on(const std::vector<int>& values, std::size_t nodal) const {
  return std::make_unique<SomeValues>(*this, values, nodal);
}

std::unique_ptr<NodalMap> IdentityMap::on(const std::vector<int>& values, std::size_t) const {
  return std::make_unique<SomeCoordinates>(values);
}

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
  if (load_->follows()) {
    u_.resize(nodal_);
    map_.displacement(q, u_);
  }
  on_nodes_.setZero(static_cast<Eigen::Index>(nodal_));
  load_->add(time, u_, on_nodes_);
  map_.lift(q, {on_nodes_.data(), nodal_}, force);
}

}  // namespace abut
