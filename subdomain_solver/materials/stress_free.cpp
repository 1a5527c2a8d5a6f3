#include "subdomain_solver/materials/stress_free.hpp"

#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Of the normal entry of an axis, in the order of the tangent.
constexpr int normal_entry(int axis) { return 4 * axis; }

}  // namespace

/// Newton on the sum of the normal stresses, as a function of the stretch; a step is halved until
/// the law has an answer and the sum does not grow in size.
bool StressFree::find_stretch(Matrix3& f, std::span<const double> before, std::span<double> after,
                              PointResponse& out) const {
  const int count = 3 - first_;
  const auto residual = [&](double stretch) {
    f.diagonal().tail(count).setConstant(stretch);
    const bool answers = law_->evaluate(f, before, after, Need::tangent, out);
    return answers ? std::abs(out.stress.diagonal().tail(count).sum()) : HUGE_VAL;
  };
  double stretch = f(2, 2), left = residual(stretch);
  if (left == HUGE_VAL) return false;
  for (int i = 0; i < 50; ++i) {
    double slope = 0.0;
    for (int a = first_; a < 3; ++a) {
      for (int b = first_; b < 3; ++b) slope += out.tangent(normal_entry(a), normal_entry(b));
    }
    if (!(slope > 0.0)) return false;  // unstable across the thickness
    double step = -out.stress.diagonal().tail(count).sum() / slope;
    // In parts of the strain, with a margin over its rounding; and F33 itself rounds at 1e-16.
    const double strain = (f - Matrix3::Identity()).cwiseAbs().maxCoeff();
    const bool small = std::abs(step) <= 1.0e-13 * strain + 1.0e-15;
    // P33 vanishes with F33 too: a step as long as F33 itself heads for a sheet without thickness.
    if (small && std::abs(step) <= 0.1 * std::abs(stretch)) return true;
    double now = residual(stretch + step);
    for (int halvings = 0; now > left; ++halvings) {
      if (halvings == 40) return false;
      step *= 0.5;
      now = residual(stretch + step);
    }
    stretch += step;
    left = now;
  }
  return false;
}

bool StressFree::evaluate(const Matrix3& f, std::span<const double> before, std::span<double> after,
                          Need want, PointResponse& out) const {
  const auto size = index(law_->history_size());
  ABUT_ASSERT(is_linear() || (before.size() == size + 1 && after.size() == size + 1));
  Matrix3 whole = is_linear() ? f : completed(f, before);
  if (is_linear()) whole(2, 2) = 1.0;
  if (!find_stretch(whole, before.first(size), after.first(size), out)) return false;
  if (!is_linear()) after[size] = whole(2, 2) - 1.0;
  for (int a = first_; a < 3; ++a) out.stress(a, a) = 0.0;
  if (want == Need::stress) return true;
  // Along the family of equal stretches; of an isotropic law that is the whole condensation.
  Eigen::Matrix<double, 9, 1> column = out.tangent.col(normal_entry(2));
  Eigen::Matrix<double, 1, 9> row = out.tangent.row(normal_entry(2));
  if (first_ == 1) {
    column += out.tangent.col(normal_entry(1));
    row += out.tangent.row(normal_entry(1));
  }
  double slope = 0.0;
  for (int a = first_; a < 3; ++a) slope += column[normal_entry(a)];
  out.tangent -= column * (row / slope);
  for (int a = first_; a < 3; ++a) {
    out.tangent.col(normal_entry(a)).setZero();
    out.tangent.row(normal_entry(a)).setZero();
  }
  return true;
}

Matrix3 StressFree::completed(const Matrix3& f, std::span<const double> after) const {
  Matrix3 whole = f;
  if (!is_linear()) whole.diagonal().tail(3 - first_).setConstant(1.0 + after.back());
  return whole;
}

}  // namespace abut
