#include "subdomain_solver/rigid/free_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/assert.hpp"

namespace abut {

namespace {

/// Angle of one series [rad]: its terms fall at least by this factor.
constexpr double reach = 0.25;
/// Where a series ends: what is left out is below the round-off of 1.
constexpr double smallest = 1.0e-17;
/// Terms until reach^n falls below it: 4^-28 = 1.4e-17, and one more.
constexpr int most_terms = 30;

}  // namespace

/// With s the second moments, I_2 - I_3 = s_3 - s_2: no difference of large numbers.
FreeRotation::FreeRotation(const Eigen::Vector3d& second_moments) {
  ABUT_ASSERT(second_moments.minCoeff() >= 0.0);
  for (int i = 0; i < 3; ++i) {
    const double sj = second_moments((i + 1) % 3), sk = second_moments((i + 2) % 3);
    inertia_(i) = sj + sk;
    ABUT_ASSERT(inertia_(i) > 0.0);
    shape_(i) = (sk - sj) / inertia_(i);
  }
}

/// Taylor series of velocity and attitude over a step, with the step as unit of time [M.62].
Eigen::Quaterniond FreeRotation::short_turn(const Eigen::Vector3d& scaled_velocity) const {
  std::array<Eigen::Vector3d, most_terms> w;   // of the velocity
  std::array<Eigen::Vector3d, most_terms> qv;  // of the attitude: vector part
  std::array<double, most_terms> qs{};         // and scalar part
  w[0] = scaled_velocity;
  qv[0].setZero();
  qs[0] = 1.0;
  const double factor = scaled_velocity.cwiseAbs().maxCoeff();
  std::size_t n = 0;
  for (double bound = factor; bound > smallest && n + 1 < most_terms; bound *= factor, ++n) {
    Eigen::Vector3d rate = Eigen::Vector3d::Zero(), turned = Eigen::Vector3d::Zero();
    double scalar = 0.0;
    for (std::size_t l = 0; l <= n; ++l) {
      const Eigen::Vector3d &a = w[l], &b = w[n - l];
      rate += Eigen::Vector3d(a(1) * b(2), a(2) * b(0), a(0) * b(1));
      turned += qs[l] * b + qv[l].cross(b);
      scalar -= qv[l].dot(b);
    }
    const double next = static_cast<double>(n + 1);
    w[n + 1] = shape_.cwiseProduct(rate) / next;
    qv[n + 1] = 0.5 / next * turned;
    qs[n + 1] = 0.5 / next * scalar;
  }
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double scalar = 0.0;
  for (std::size_t k = n + 1; k-- > 0;) {  // the small terms first
    vector += qv[k];
    scalar += qs[k];
  }
  return Eigen::Quaterniond(scalar, vector(0), vector(1), vector(2)).normalized();
}

Eigen::Quaterniond FreeRotation::turn(const Eigen::Vector3d& momentum, double time) const {
  Eigen::Quaterniond total = Eigen::Quaterniond::Identity();
  double left = time;
  while (left != 0.0) {
    // Angular momentum stays in space: along the body's axes it is turned back.
    const Eigen::Vector3d now = total.conjugate() * momentum;
    const Eigen::Vector3d velocity = now.cwiseQuotient(inertia_);
    const double fastest = velocity.cwiseAbs().maxCoeff();
    double step = left;
    if (fastest * std::abs(left) > reach) step = std::copysign(reach / fastest, left);
    total = (total * short_turn(step * velocity)).normalized();
    left = step == left ? 0.0 : left - step;
  }
  return total;
}

}  // namespace abut
