#include "subdomain_solver/materials/plane.hpp"

#include <array>
#include <cmath>

#include "base/assert.hpp"

namespace abut {

namespace {

constexpr std::array<int, 5> entries = {0, 1, 3, 4, 8};
constexpr int normal_entry = 8;

}  // namespace

Matrix3 embed(const Eigen::Matrix2d& f, double normal) {
  Matrix3 whole = Matrix3::Zero();
  whole.topLeftCorner<2, 2>() = f;
  whole(2, 2) = normal;
  return whole;
}

PlaneEntries in_plane(const Matrix3& tensor) { return tensor.reshaped()(entries); }

PlaneTangent in_plane(const Tangent& tangent) { return tangent(entries, entries); }

/// Newton on P33(F33) = 0; a step is halved until the law has an answer and |P33| does not grow.
bool PlaneStress::find_normal(Matrix3& f, std::span<const double> before, std::span<double> after,
                              PointResponse& out) const {
  const auto residual = [this, &f, before, after, &out](double normal) {
    f(2, 2) = normal;
    const bool answers = law_->evaluate(f, before, after, Want::tangent, out);
    return answers ? std::abs(out.stress(2, 2)) : HUGE_VAL;
  };
  double normal = f(2, 2), left = residual(normal);
  if (left == HUGE_VAL) return false;
  for (int i = 0; i < 50; ++i) {
    const double slope = out.tangent(normal_entry, normal_entry);
    if (!(slope > 0.0)) return false;  // the sheet is unstable across its thickness
    double step = -out.stress(2, 2) / slope;
    // In parts of the strain, with a margin over its rounding; and F33 itself rounds at 1e-16.
    const double strain = (f - Matrix3::Identity()).cwiseAbs().maxCoeff();
    const bool small = std::abs(step) <= 1.0e-13 * strain + 1.0e-15;
    // P33 vanishes with F33 too: a step as long as F33 itself heads for a sheet without thickness.
    if (small && std::abs(step) <= 0.1 * std::abs(normal)) return true;
    double now = residual(normal + step);
    for (int halvings = 0; now > left; ++halvings) {
      if (halvings == 40) return false;
      step *= 0.5;
      now = residual(normal + step);
    }
    normal += step;
    left = now;
  }
  return false;
}

Matrix3 PlaneStress::completed(const Matrix3& f, std::span<const double> after) const {
  Matrix3 whole = f;
  if (!is_linear()) whole(2, 2) = 1.0 + after.back();
  return whole;
}

bool PlaneStress::evaluate(const Matrix3& f, std::span<const double> before,
                           std::span<double> after, Want want, PointResponse& out) const {
  const auto size = static_cast<std::size_t>(law_->history_size());
  ABUT_ASSERT(is_linear() || (before.size() == size + 1 && after.size() == size + 1));
  Matrix3 whole = f;
  whole(2, 2) = is_linear() ? 1.0 : 1.0 + before[size];
  if (!find_normal(whole, before.first(size), after.first(size), out)) return false;
  if (!is_linear()) after[size] = whole(2, 2) - 1.0;
  out.stress(2, 2) = 0.0;
  if (want == Want::stress) return true;
  const Eigen::Matrix<double, 9, 1> column = out.tangent.col(normal_entry);
  const Eigen::Matrix<double, 1, 9> row = out.tangent.row(normal_entry);
  out.tangent -= column * (row / column[normal_entry]);
  out.tangent.col(normal_entry).setZero();
  out.tangent.row(normal_entry).setZero();
  return true;
}

}  // namespace abut
