#pragma once

#include <utility>

#include "subdomain_solver/nodal_map.hpp"

namespace abut {

/// Modal rungs: nodes move by shapes times amplitudes, u = Phi q.
class ModalMap final : public NodalMap {
 public:
  /// Phi (nodal values, modes), in the nodes' own frames.
  explicit ModalMap(Eigen::MatrixXd shapes) : shapes_(std::move(shapes)) {}

  void displacement(std::span<const double> q, std::span<double> u) const override;
  void velocity(std::span<const double> q, std::span<const double> v,
                std::span<double> out) const override;
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::span<double> out) const override;
  void lift(std::span<const double> q, std::span<const double> nodal, Vector& force) const override;
  std::unique_ptr<NodalMap> on(const std::vector<int>& values, std::size_t nodal) const override;

 private:
  Eigen::MatrixXd shapes_;
};

}  // namespace abut
