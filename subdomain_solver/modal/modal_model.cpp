#include "subdomain_solver/modal/modal_model.hpp"

#include <cmath>
#include <limits>

namespace abut {

ModalModel::ModalModel(const Vector& frequencies)
    : stiffness_(frequencies.cwiseAbs2()), lumped_(Vector::Ones(frequencies.size())) {
  mass_ = mass_matrix(*this, MassForm::lumped);
  tangent_ = mass_;
  Eigen::Map<Vector>(tangent_.valuePtr(), tangent_.nonZeros()) = stiffness_;
}

double ModalModel::roundoff(std::span<const double> q) const {
  const Eigen::Map<const Vector> amplitudes(q.data(), static_cast<Eigen::Index>(q.size()));
  return summed_roundings * std::numeric_limits<double>::epsilon() *
         stiffness_.cwiseProduct(amplitudes).norm();
}

bool ModalModel::evaluate(std::span<const double> q, std::span<const double>, Want want,
                          ModelResponse& out) {
  const Eigen::Map<const Vector> amplitudes(q.data(), static_cast<Eigen::Index>(q.size()));
  out.force = stiffness_.cwiseProduct(amplitudes);
  if (want == Want::tangent) out.tangent = tangent_;
  out.history.clear();
  out.stored = 0.5 * out.force.dot(amplitudes);
  out.dissipation = 0.0;
  return true;
}

double ModalModel::stable_step() const {
  const double highest = stiffness_.size() > 0 ? std::sqrt(stiffness_.maxCoeff()) : 0.0;
  return highest > 0.0 ? 2.0 / highest : std::numeric_limits<double>::infinity();
}

}  // namespace abut
