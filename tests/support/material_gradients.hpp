#pragma once

#include <algorithm>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {

/// Derivative of a value (a vector) along one entry of F, by the central difference of fourth
/// order.
template <class Value>
Eigen::VectorXd difference(const Value& value, const Matrix3& f, int entry, double h) {
  const auto at = [&value, &f, entry](double shift) -> Eigen::VectorXd {
    Matrix3 moved = f;
    moved.reshaped()[entry] += shift;
    return value(moved);
  };
  return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}

/// Distance of a derivative to its difference with half a step, in parts of what that difference
/// may be off. Of fourth order, it is 15 times closer to the derivative than to the difference with
/// the whole step (8 for safety), and it rounds: twenty roundings of a number of size `scale`. That
/// bound must be small itself, or the sample sits on a kink.
template <class Value>
double difference_error(const Eigen::VectorXd& exact, const Value& value, const Matrix3& f,
                        int entry, double scale) {
  const double step = 5.0e-4;
  const Eigen::VectorXd whole = difference(value, f, entry, step);
  const Eigen::VectorXd half = difference(value, f, entry, 0.5 * step);
  const double rounding = 1.5 * roundoff(20.0, scale) / (0.5 * step);
  const double off = (whole - half).cwiseAbs().maxCoeff() / 8.0 + rounding;
  EXPECT_LT(off, 1.0e-8 * scale);  // far above h^4 and rounding, 3e-11; kinks leave h
  return (exact - half).cwiseAbs().maxCoeff() / off;
}

/// Largest such distance of P to the gradient of energy + dissipation along the entries.
inline double gradient_error(const Material& law, const Matrix3& f, History start,
                             std::span<const int> entries) {
  const auto potential = [&law, &start](const Matrix3& x) -> Eigen::VectorXd {
    const PointResponse r = answer(law, x, start, false, Need::stress);
    return Eigen::VectorXd::Constant(1, r.energy + r.dissipation);
  };
  const PointResponse at = answer(law, f, start);
  double most = 0.0;
  for (const int i : entries) {
    const Eigen::VectorXd exact = Eigen::VectorXd::Constant(1, at.stress.reshaped()[i]);
    const double scale = at.tangent.cwiseAbs().maxCoeff();
    most = std::fmax(most, difference_error(exact, potential, f, i, scale));
  }
  return most;
}

/// Largest such distance of the tangent to the gradient of P along the entries.
inline double tangent_error(const Material& law, const Matrix3& f, History start,
                            std::span<const int> entries) {
  const auto stress = [&law, &start](const Matrix3& x) -> Eigen::VectorXd {
    return answer(law, x, start, false, Need::stress).stress.reshaped();
  };
  const Tangent tangent = answer(law, f, start).tangent;
  double most = 0.0;
  for (const int i : entries)
    most = std::fmax(most,
                     difference_error(tangent.col(i), stress, f, i, tangent.cwiseAbs().maxCoeff()));
  return most;
}

}  // namespace abut
