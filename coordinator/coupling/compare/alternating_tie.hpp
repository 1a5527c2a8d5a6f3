#pragma once

#include "coordinator/coupling/compare/remaining_way.hpp"
#include "coordinator/coupling/tie.hpp"

namespace abut {

/// Motions alone as alternating Schwarz finds them, in its parallel form: in every sweep a body
/// follows where the other one was, as if that stood still  [M.116]. Nets of these are
/// AlternatingNet.
class AlternatingTie final : public Tie {
 public:
  explicit AlternatingTie(TieRows rows) : Tie(std::move(rows), EnergyAccount::doubled) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  const SparseRows& kernel_rows(int side) const override { return rows_.force[side]; }

 private:
  RemainingWay way_;  // [m] how each row's own side moves
};

}  // namespace abut
