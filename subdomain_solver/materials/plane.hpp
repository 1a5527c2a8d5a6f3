#pragma once

#include <memory>
#include <utility>

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Kinematics of bodies in two dimensions; three need no choice.
enum class Plane { strain, stress, axisymmetric };

/// The entries of a tensor that vary in the plane, in the order 11, 21, 12, 22, 33 (the order of
/// the tangent). 33 is 1 in plane strain, the hoop stretch r/R in axisymmetry, and in plane stress
/// an inner unknown.
using PlaneEntries = Eigen::Matrix<double, 5, 1>;
using PlaneTangent = Eigen::Matrix<double, 5, 5>;

/// F of space from F of the plane and the stretch normal to it.
Matrix3 embed(const Eigen::Matrix2d& f, double normal = 1.0);
PlaneEntries in_plane(const Matrix3& tensor);
PlaneTangent in_plane(const Tangent& tangent);

/// Any law under plane stress [M.37], itself a law: F33 of its argument is not read but found from
/// P33 = 0, and the tangent is condensed, so row and column 33 of the answer are zero. Entries 13,
/// 23, 31, 32 of F must be zero. The history is that of the law and F33 - 1, from which the next
/// search starts; a linear law needs no start and has no history. evaluate is false where the law
/// has no answer and where no F33 is found, e.g. Saint Venant-Kirchhoff at large biaxial stretch.
class PlaneStress final : public Material {
 public:
  explicit PlaneStress(std::unique_ptr<const Material> law) : law_(std::move(law)) {}

  double density() const override { return law_->density(); }
  Moduli moduli() const override { return law_->moduli(); }  // of space: a bound on wave speeds
  bool is_linear() const override { return law_->is_linear(); }
  int history_size() const override { return law_->history_size() + (is_linear() ? 0 : 1); }
  std::vector<NamedHistory> named_history() const override { return law_->named_history(); }
  Matrix3 completed(const Matrix3& f, std::span<const double> after) const override;
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Want want,
                              PointResponse& out) const override;

 private:
  [[nodiscard]] bool find_normal(Matrix3& f, std::span<const double> before,
                                 std::span<double> after, PointResponse& out) const;

  std::unique_ptr<const Material> law_;
};

}  // namespace abut
