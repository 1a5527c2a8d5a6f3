#pragma once

#include <limits>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/kernel_inverse.hpp"
#include "coordinator/coupling/trial.hpp"

namespace abut {

/// The kinematic side meets the partner's moving surface as a one-body problem and returns the
/// complete reaction; the other side takes that reaction as impulses. Iterated is the Neumann
/// side's motion, never the force, so momentum is exact in every iterate  [M.9].
class Unilateral final : public Exchange {
 public:
  /// Trials are asked for where windows without them would miss `tolerance`; infinity: never.
  explicit Unilateral(double tolerance = 0.0) : tolerance_(tolerance) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return neumann_grid_.count; }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const override;
  double first_factor() const override { return first_factor_; }
  bool projects() const override { return projects_; }
  bool ordered() const override { return true; }
  void state(Archive& archive) override;

 private:
  Substeps kinematic_grid_, neumann_grid_;  // iterated is u at the ends of the Neumann side's
  double u_begin_ = 0.0, v_begin_ = 0.0;    // of the Neumann port
  Waveform guess_;  // last iterate: a window that is cut short starts from it
  ReferenceScales scale_;
  double kinematic_compliance_ = 0.0, neumann_compliance_ = 0.0;  // [m/N] over one substep
  double roundoff_gain_ = 1.0;  // of displacements, through the reaction
  double first_factor_ = 1.0;
  double tolerance_;
  TimeWindow window_;
  Trial trial_;
  bool looks_ = false;  // both sides look on after the window
  double straight_residual_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd predicted_;  // [m] as the iterate; empty: there is no trial
  void find_inverse(const Joint& joint, double length, const Bodies& bodies);
  void see_trial(const TimeWindow& window, const Joint& joint, Bodies& bodies);
  void see_overlap(const Joint& joint, const Waveform& k, const Waveform& n);
  Eigen::VectorXd straight() const;
  void see_contact(const Joint& joint, const Bodies& bodies);

  // of contact at one point: kernels, and what the last sweep left on K's side at its substeps
  bool unilateral_ = true;  // contact: every substep decides for itself
  bool projects_ = false;
  bool alike_ = false;  // both sides take the same substeps
  const PortKernel* kernel_k_ = nullptr;
  const PortKernel* kernel_n_ = nullptr;
  double outward_n_ = 1.0;
  Eigen::VectorXd overlap_, force_;  // [m] [N] compressive
  KernelInverse inverses_;
  const KernelInverse::Entry* inverse_ = nullptr;
};

}  // namespace abut
