#pragma once

#include <cmath>

#include "subdomain_solver/solve/friction_forces.hpp"

namespace abut {

/// One row of contact against all others: its block D [m/N] and what its rates b would be without
/// it.
class OneRow {
 public:
  using Tangent = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
  using PlaneSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;

  /// `block`: (parts, parts) of the row. Precondition: the row outlives it.
  OneRow(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& block,
         const FrictionRow& row)
      : row_(row),
        tangents_(row.parts - 1),
        normal_(block(0, 0)),
        couple_(block.col(0).segment(1, tangents_)),
        give_(block.block(1, 1, tangents_, tangents_)) {}

  /// Forces [N] (normal, tangents) for rates b [m] without it; z is the guess.
  void solve(double gap, const Eigen::Ref<const Vector>& slip, Eigen::Ref<Vector> z) const {
    if (gap >= 0.0) {
      z.setZero();
      return;
    }
    if (tangents_ == 0) {
      z(0) = -gap / normal_;
      return;
    }
    stick(gap, slip, z);
    const double most = z(0) > 0.0 ? row_.friction * z(0) : 0.0, size = z.tail(tangents_).norm();
    if (z(0) > 0.0 && size <= most) return;
    slide(gap, slip, z);
  }

 private:
  static constexpr int most_turns = 30;  // of the direction in which it slips
  static constexpr double settled_way = 1.0e-14;

  void stick(double gap, const Eigen::Ref<const Vector>& slip, Eigen::Ref<Vector> z) const {
    const Tangent lean = inverse_of(couple_), rest = inverse_of(slip);
    z(0) = -(gap - couple_.dot(rest)) / (normal_ - couple_.dot(lean));
    z.tail(tangents_) = -rest - lean * z(0);
  }
  Tangent inverse_of(const Eigen::Ref<const Vector>& v) const {
    if (tangents_ == 1) return Tangent::Constant(1, v(0) / give_(0, 0));
    const double det = give_(0, 0) * give_(1, 1) - give_(0, 1) * give_(1, 0);
    Tangent out(2);
    out << (give_(1, 1) * v(0) - give_(0, 1) * v(1)) / det,
        (give_(0, 0) * v(1) - give_(1, 0) * v(0)) / det;
    return out;
  }
  double pressing(double gap, const Tangent& way) const {
    const double give = normal_ + row_.friction * couple_.dot(way);
    return give > 0.0 ? -gap / give : -gap / normal_;
  }
  /// The direction of tau by turns: tau leads where tau - rho w_t does.
  void slide(double gap, const Eigen::Ref<const Vector>& slip, Eigen::Ref<Vector> z) const {
    Tangent way = z.tail(tangents_);
    if (z(0) <= 0.0 || way.norm() == 0.0) way = -slip;
    if (way.norm() > 0.0) way.normalize();
    const double rho = 1.0 / give_.trace();
    for (int turn = 0; turn < most_turns; ++turn) {
      z(0) = pressing(gap, way);
      const Tangent tau = row_.friction * z(0) * way;
      Tangent next = tau - rho * (slip + couple_ * z(0) + give_ * tau);
      if (next.norm() == 0.0) break;
      next.normalize();
      const double change = (next - way).norm();
      way = next;
      if (change <= settled_way) break;
    }
    z(0) = pressing(gap, way);
    z.tail(tangents_) = row_.friction * z(0) * way;
  }

  const FrictionRow& row_;
  Eigen::Index tangents_;
  double normal_;
  Tangent couple_;
  PlaneSquare give_;
};

}  // namespace abut
