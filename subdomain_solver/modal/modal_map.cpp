#include "subdomain_solver/modal/modal_map.hpp"

namespace abut {

namespace {

Eigen::Map<const Vector> values_view(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

void ModalMap::displacement(std::span<const double> q, std::span<double> u) const {
  Eigen::Map<Vector>(u.data(), shapes_.rows()).noalias() = shapes_ * values_view(q);
}

void ModalMap::velocity(std::span<const double>, std::span<const double> v,
                        std::span<double> out) const {
  displacement(v, out);
}

void ModalMap::acceleration(std::span<const double>, std::span<const double>,
                            std::span<const double> a, std::span<double> out) const {
  displacement(a, out);
}

void ModalMap::lift(std::span<const double>, std::span<const double> nodal, Vector& force) const {
  force.noalias() += shapes_.transpose() * values_view(nodal);
}

std::unique_ptr<NodalMap> ModalMap::on(const std::vector<int>& values, std::size_t) const {
  return std::make_unique<ModalMap>(shapes_(values, Eigen::all));
}

}  // namespace abut
