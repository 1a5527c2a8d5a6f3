#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/tie_kernel.hpp"
#include "coordinator/coupling/tie_kernel_plan.hpp"
#include "coordinator/coupling/tied_port.hpp"

namespace abut {

/// All ties of an island at once: how forces in any of them move the sides of any other apart, by
/// the port kernels of the bodies, which reach from port to port [M.109]. Linear bodies are
/// answered exactly, whatever the net, where kernels of all rows on all others fit. Where nothing
/// but ties holds bodies without inertia, places of their loose motions are found with the forces
/// [M.112].
class TieNet {
 public:
  explicit TieNet(const TieKernelOptions& options) : options_(options) {}

  /// A window begins: the ties have laid out their iterates. `first`: of the joints of the island,
  /// where their parts of a stacked vector begin.
  void begin(const KnownExchanges& known, std::span<const Eigen::Index> first, Bodies& bodies);
  /// After a sweep: bodies without inertia that are not linear are asked anew how they give way.
  /// True: what they say is the derivative at this sweep, better than secants.
  bool renew(Bodies& bodies);
  /// What a residual g - x shows that no forces answer: motions that are given to both sides and
  /// differ, in words. Empty: the sweep says nothing of the kind, or not yet. What is no more than
  /// meshes leave of such motions stays open: ties then measure without it.
  std::string contradiction(const Eigen::VectorXd& r, double tolerance, double time,
                            const Bodies& bodies, bool& stays_open) const;
  bool empty() const { return layout_.empty(); }
  /// First guesses, where all bodies have told how they would part.
  void predict(Eigen::VectorXd& x) const;
  /// What the net answers to forces on some points of a port that touches, over all of a window;
  /// null: its body is not tied, or where bodies of the net step unlike. Good until the next window
  /// begins. `most`: [B] that it may take.
  const TiedPort* touching(const Side& side, const std::vector<std::int32_t>& points, double most,
                           Bodies& bodies);
  bool joins(int body) const;
  /// Kernels of linear bodies are found anew, equal to the last bit.
  void state(Archive& archive);
  const TieLayout& layout() const { return layout_; }
  /// Answers the ties' parts of a residual g - x, in the ties' units; leaves the others alone.
  void apply_inverse(Eigen::VectorXd& r) const;

 private:
  void find_kernel(Bodies& bodies);
  Eigen::VectorXd jumps(const Eigen::VectorXd& r) const;

  TieKernelOptions options_;
  TieLayout layout_;
  std::vector<int> pattern_;      // of the layout for which the kernel holds
  int blocks_ = 0;                // the same
  std::vector<double> restored_;  // of the kernel that is found next; empty: nothing
  std::unique_ptr<TieKernel> kernel_;
  struct Touching {
    int body = 0, port = 0;
    std::unique_ptr<TiedPort> answer;
  };
  std::vector<Touching> touching_;
};

}  // namespace abut
