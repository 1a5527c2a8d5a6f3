#include "subdomain_solver/materials/finite_strain.hpp"

#include <cmath>

#include <Eigen/LU>

namespace abut {

namespace {

/// det(I + H) - 1 by its invariants.
double volume_growth(const Matrix3& h) {
  const double minors = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0) + h(1, 1) * h(2, 2) -
                        h(1, 2) * h(2, 1) + h(2, 2) * h(0, 0) - h(2, 0) * h(0, 2);
  return h.trace() + minors + h.determinant();
}

bool is_admissible(double j) { return j > 0.0 && std::isfinite(j); }

/// Of H = F - I.
Matrix3 green_of(const Matrix3& h) { return 0.5 * (h + h.transpose() + h.transpose() * h); }

}  // namespace

bool green_strain(const Matrix3& f, Matrix3& out) {
  out = green_of(f - Matrix3::Identity());
  return is_admissible(f.determinant());
}

bool FiniteStrain::from(const Matrix3& f, FiniteStrain& out) {
  const double j = f.determinant();
  if (!is_admissible(j)) return false;
  const Matrix3 h = f - Matrix3::Identity();
  // Beyond the neighbourhood of I the determinant itself is the more accurate one.
  const bool near = h.cwiseAbs().maxCoeff() < 0.25;
  const double growth = near ? volume_growth(h) : j - 1.0;
  out.log_volume = near ? std::log1p(growth) : std::log(j);
  out.square_growth = growth * (2.0 + growth);
  out.green = green_of(h);
  out.finger = h + h.transpose() + h * h.transpose();
  out.inverse_transpose = f.inverse().transpose();
  return out.inverse_transpose.allFinite();
}

Tangent outer(const Matrix3& a, const Matrix3& b) {
  return a.reshaped() * b.reshaped().transpose();
}

Tangent kronecker(const Matrix3& a, const Matrix3& b) {
  Tangent t;
  for (int l = 0; l < 3; ++l)
    for (int j = 0; j < 3; ++j) t.block<3, 3>(3 * j, 3 * l) = b(j, l) * a;
  return t;
}

Tangent crossed(const Matrix3& a, const Matrix3& b) {
  Tangent t;
  for (int l = 0; l < 3; ++l)
    for (int j = 0; j < 3; ++j) t.block<3, 3>(3 * j, 3 * l) = a.col(l) * b.col(j).transpose();
  return t;
}

}  // namespace abut
