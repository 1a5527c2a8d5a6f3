#pragma once

#include <array>
#include <vector>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/kernel_inverse.hpp"
#include "coordinator/coupling/trial.hpp"

namespace abut {

/// Both sides take the same contact force and advance at once; iterated is the force at the coarser
/// side's substeps until no overlap is left  [M.12].
class ParallelForce final : public Exchange {
 public:
  explicit ParallelForce(bool trials = true) : trials_(trials) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return grid_.count; }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const override;
  bool projects() const override { return projects_; }
  bool ordered() const override { return false; }
  void state(Archive& archive) override;

 private:
  void see_trial(const std::array<Substeps, 2>& grids, const Joint& joint, Bodies& bodies);
  double see_overlap(const Joint& joint, const std::array<const Waveform*, 2>& motions);
  void find_inverse(const std::vector<const PortKernel*>& kernels, const TimeWindow& window,
                    const Joint& joint, const Bodies& bodies);

  Substeps grid_;           // of the force, compressive
  bool unilateral_ = true;  // contact: every substep decides for itself
  bool projects_ = false;
  Eigen::VectorXd overlap_, force_;  // [m] [N] of the last image
  ForceSupport support_ = ForceSupport::nodal;
  double force_begin_ = 0.0;  // [N] known at the window's begin
  Waveform guess_;
  ReferenceScales scale_;
  double compliance_ = 0.0;  // [m/N] of both sides over one substep
  TimeWindow window_;
  bool trials_;
  Trial trial_;
  bool looks_ = false;         // both sides look on after the window
  Eigen::VectorXd predicted_;  // [N] as the iterate; empty: there is no trial
  KernelInverse inverses_;
  const KernelInverse::Entry* inverse_ = nullptr;
};

}  // namespace abut
