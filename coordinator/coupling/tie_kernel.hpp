#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "coordinator/coupling/tie_layout.hpp"

namespace abut {

/// How forces of all ties of a net move their rows apart, and the forces that make up for jumps:
/// equal blocks below each other by lag, so that the inverse needs that of the first  [M.109].
class TieKernel {
 public:
  virtual ~TieKernel() = default;
  /// Forces that make up for jumps; both (blocks, size of a block).
  Eigen::VectorXd solve(const Eigen::VectorXd& jump) const;
  /// What is left of jumps that no force answers, where rows say the same twice or nothing gives
  /// way: an empty vector where every jump has its force.
  Eigen::VectorXd unanswered(const Eigen::VectorXd& jump) const;
  /// [m/N] of the first block.
  virtual Eigen::VectorXd diagonal() const = 0;
  virtual Eigen::Index size() const = 0;  // of a block
  virtual int lags() const = 0;           // blocks
  /// Asks bodies that bend (TieLayout::Part) anew. True: what it says of this sweep is better than
  /// secants, of such bodies and of those that turn.
  virtual bool renew(const TieLayout& layout, Bodies& bodies) = 0;
  /// A window begins: what bodies that turn (TieLayout::Part) answer turns with their ports.
  virtual void turn(const TieLayout& layout) = 0;
  /// What bodies that bend or turn told, which later ones of the same layout take over; empty: all
  /// are linear.
  virtual std::vector<double> answers() const = 0;
  virtual void take(const TieLayout& layout, std::span<const double> answers) = 0;

 private:
  /// Whether there may be jumps without an answer.
  virtual bool redundant() const = 0;
  /// left -= block of a lag times forces.
  virtual void subtract(int lag, const Eigen::Ref<const Eigen::VectorXd>& force,
                        Eigen::VectorXd& left) const = 0;
  Eigen::VectorXd march(const Eigen::VectorXd& jump, Eigen::VectorXd* rest) const;
  /// Of the first block.
  virtual Eigen::VectorXd invert(const Eigen::VectorXd& jump) const = 0;
};

/// Every row on every other one: exact for linear bodies, which are probed row by row. `lags`:
/// blocks; what a force does after them is left out.
std::unique_ptr<TieKernel> make_dense_tie_kernel(const TieLayout& layout, int lags, Bodies& bodies);

}  // namespace abut
