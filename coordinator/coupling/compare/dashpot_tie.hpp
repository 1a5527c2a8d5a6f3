#pragma once

#include <memory>

#include "coordinator/coupling/tie.hpp"

namespace abut {

/// Rows of both sides, each a dashpot with the partner's force  [M.117]: in a window the sides part
/// by what dashpots give way to the impulses of the window. For comparisons, since it loses what
/// one side's mesh or steps cannot follow of the other's.
class DashpotTie final : public Tie {
 public:
  /// `give`: [m/(N s)] (rows over rows) by which rows part under impulses.
  DashpotTie(TieRows rows, SparseRows give)
      : Tie(std::move(rows), EnergyAccount::unknown), give_(std::move(give)) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  void give_way(int lag, int steps, const AddEntry& add) const override;

 private:
  SparseRows give_;
};

/// `impedance` [kg/s] in all, shared by area. No rows: as in make_tie_rows.
std::unique_ptr<Tie> make_dashpot_tie(const PortGeometry& one, const PortGeometry& other,
                                      double impedance);

}  // namespace abut
