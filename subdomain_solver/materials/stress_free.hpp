#pragma once

#include <memory>
#include <utility>

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Any isotropic law without normal stress along the last axes, itself a law [M.37]: their stretch,
/// one for all of them, is not read from F but found from P = 0, and the tangent is condensed, so
/// their rows and columns of the answer are zero. Shears of these axes in F must be zero. The
/// history is that of the law and the stretch less 1, from which the next search starts; a linear
/// law needs no start and has no history. evaluate is false where the law has no answer and where
/// no stretch is found, e.g. Saint Venant-Kirchhoff at large biaxial stretch.
class StressFree : public Material {
 public:
  double density() const override { return law_->density(); }
  Moduli moduli() const override { return law_->moduli(); }  // of space: a bound on wave speeds
  bool is_linear() const override { return law_->is_linear(); }
  bool resists_crushing() const override { return law_->resists_crushing(); }
  int history_size() const override { return law_->history_size() + (is_linear() ? 0 : 1); }
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;
  std::vector<NamedHistory> named_history() const override { return law_->named_history(); }
  Matrix3 completed(const Matrix3& f, std::span<const double> after) const override;

 protected:
  /// `first` of the axes without stress: 2 (the third alone) or 1 (second and third).
  StressFree(std::unique_ptr<const Material> law, int first)
      : law_(std::move(law)), first_(first) {}

 private:
  [[nodiscard]] bool find_stretch(Matrix3& f, std::span<const double> before,
                                  std::span<double> after, PointResponse& out) const;

  std::unique_ptr<const Material> law_;
  int first_;
};

/// A sheet in the plane 12, free to thin.
class PlaneStress final : public StressFree {
 public:
  explicit PlaneStress(std::unique_ptr<const Material> law) : StressFree(std::move(law), 2) {}
};

/// A bar along axis 1, its cross section free to swell and shrink.
class UniaxialStress final : public StressFree {
 public:
  explicit UniaxialStress(std::unique_ptr<const Material> law) : StressFree(std::move(law), 1) {}
};

}  // namespace abut
