#pragma once

#include <cmath>

#include "subdomain_solver/solve/friction_forces.hpp"

namespace abut {

/// One row of contact against all others: its block D [m/N] and what its rates b would be without
/// it. `Tangents`: how many it has; Dynamic: 0 to 2, for who does not care for time. The bits are
/// the same.
template <int Tangents = Eigen::Dynamic>
class OneRow {
 public:
  static constexpr int at_most = Tangents == Eigen::Dynamic ? 2 : Tangents;
  static constexpr int all = Tangents == Eigen::Dynamic ? Eigen::Dynamic : Tangents + 1;
  using Tangent = Eigen::Matrix<double, Tangents, 1, 0, at_most, 1>;
  using PlaneSquare = Eigen::Matrix<double, Tangents, Tangents, 0, at_most, at_most>;
  using Block = Eigen::Matrix<double, all, all>;
  using Forces = Eigen::Matrix<double, all, 1>;

  /// `block`: (parts, parts) of the row. Precondition: the row outlives it.
  OneRow(const Eigen::Ref<const Block, 0, Eigen::OuterStride<>>& block, const FrictionRow& row)
      : row_(row),
        normal_(block(0, 0)),
        couple_(block.template block<Tangents, 1>(1, 0, tangents(), 1)),
        give_(block.template block<Tangents, Tangents>(1, 1, tangents(), tangents())) {}

  /// Forces [N] (normal, tangents) for rates b [m] without it; z is the guess.
  void solve(double gap, const Tangent& slip, Eigen::Ref<Forces> z) const {
    if (gap >= 0.0) {
      z.setZero();
      return;
    }
    if (tangents() == 0) {
      z(0) = -gap / normal_;
      return;
    }
    stick(gap, slip, z);
    const double most = z(0) > 0.0 ? row_.friction * z(0) : 0.0, size = tail(z).norm();
    if (z(0) > 0.0 && size <= most) return;
    slide(gap, slip, z);
  }

 private:
  Eigen::Index tangents() const {
    if constexpr (Tangents == Eigen::Dynamic) return row_.parts - 1;
    return Tangents;
  }
  auto tail(Eigen::Ref<Forces>& z) const {
    return z.template block<Tangents, 1>(1, 0, tangents(), 1);
  }
  static constexpr int most_turns = 30;  // of the direction in which it slips
  static constexpr double settled_way = 1.0e-14;

  void stick(double gap, const Tangent& slip, Eigen::Ref<Forces> z) const {
    const Tangent lean = inverse_of(couple_), rest = inverse_of(slip);
    z(0) = -(gap - couple_.dot(rest)) / (normal_ - couple_.dot(lean));
    tail(z) = -rest - lean * z(0);
  }
  Tangent inverse_of(const Tangent& v) const {
    Tangent out(v.size());
    if (tangents() == 1) {
      out(0) = v(0) / give_(0, 0);
      return out;
    }
    if constexpr (Tangents != 1) {
      const double det = give_(0, 0) * give_(1, 1) - give_(0, 1) * give_(1, 0);
      out(0) = (give_(1, 1) * v(0) - give_(0, 1) * v(1)) / det;
      out(1) = (give_(0, 0) * v(1) - give_(1, 0) * v(0)) / det;
    }
    return out;
  }
  double pressing(double gap, const Tangent& way) const {
    const double give = normal_ + row_.friction * couple_.dot(way);
    return give > 0.0 ? -gap / give : -gap / normal_;
  }
  /// The direction of tau by turns: tau leads where tau - rho w_t does.
  void slide(double gap, const Tangent& slip, Eigen::Ref<Forces> z) const {
    Tangent way = tail(z);
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
    tail(z) = row_.friction * z(0) * way;
  }

  const FrictionRow& row_;
  double normal_;
  Tangent couple_;
  PlaneSquare give_;
};

}  // namespace abut
