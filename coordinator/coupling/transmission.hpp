#pragma once

#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Dense>

#include "contract/time_window.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/convergence.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/coupling/kernel_inverse.hpp"
#include "coordinator/coupling/trial.hpp"

namespace abut {

class Tie;
class TieNet;
class TiedPort;
struct TieLayout;

/// What the partner's response imposes on each side of a closed joint, and what is iterated: values
/// of its ports' points and components at the substeps of a window, (substeps, width), in SI units.
/// A window runs  begin, (release, see_flight), predict, (impose side by side, image, measure)*;  x
/// is the joint's part of the stacked iterate.
class Transmission {
 public:
  virtual ~Transmission() = default;

  /// Whether the Neumann side's body has other closed joints in the window that begins next.
  virtual void share(bool) {}
  /// Lays out the iterate of a window; the latest responses hold the state at its begin.
  virtual void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) = 0;
  virtual int values() const = 0;
  /// Whether the first guess is a flight: the Neumann side is advanced once, as `release` asks, and
  /// brought back, before the guess is made.
  virtual bool flies() const { return false; }
  virtual void release(const Joint&, Bodies&) {}
  virtual void see_flight(const Joint&, const Bodies&) {}
  virtual void predict(Eigen::Ref<Eigen::VectorXd> x) const = 0;
  /// Fills the request of one side's body.
  virtual void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                      Bodies& bodies) = 0;
  /// G(x), out of the responses of this sweep.
  virtual void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                     const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) = 0;
  virtual FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                 const Eigen::Ref<const Eigen::VectorXd>& g) const = 0;
  /// Motion that mismatches are measured by, over that of this sweep and the first: above 1 after a
  /// sweep that went astray, which must not let those after it pass.
  virtual double stray() const { return 1.0; }
  /// Factors that make all entries of the iterate comparable: 1 / unit of each entry.
  virtual void scales(Eigen::Ref<Eigen::VectorXd> s) const = 0;
  /// Approximate J^-1 r, J = -d(G - x)/dx, from the port kernels.
  virtual Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const = 0;
  /// Relaxation factor of a first correction, by impedance probe: stiffness of the Neumann side
  /// over that of both, each the inverse of its port kernel's first coefficient. 1 where one is not
  /// needed: what is iterated is scaled by the probe already, or the form is the published one.
  virtual double first_factor() const { return 1.0; }
  /// True when contact came or went within the window at the last image, and apply_inverse answers
  /// that exactly for linear bodies: secants of other substeps in contact would spoil it.
  virtual bool projects() const { return false; }
  /// True when small plain steps, of the first factor, contract: a residual that grows is the doing
  /// of secants, of another state or from the other side of a kink, where points come and go.
  virtual bool contracts() const { return false; }
  /// True when motion is overwritten on a side: that does work of which nobody knows.
  virtual bool overwrites_motion() const { return false; }
  /// The ties of bodies on either side have laid out their iterates: what they answer to contact.
  /// False: that is not known.
  virtual bool ease(TieNet&, const Joint&, Bodies&) { return false; }
  /// Their answer is not told any more.
  virtual void withdraw(const Joint&, Bodies&) {}
  /// The forces of ties change by their parts of a stacked vector: adds what that does to g - x.
  virtual void follow(const Eigen::VectorXd&, Eigen::Ref<Eigen::VectorXd>) const {}
  /// Itself where it is one of a net's ties, which are answered together (TieNet).
  virtual Tie* tie() { return nullptr; }
  /// True when the sides must be advanced one after the other, the kinematic one first.
  virtual bool ordered() const = 0;
};

/// Values of a port at the ends of the substeps of a window: where they are in an iterate.
struct IterateGrid {
  Substeps steps;
  int width = 1;

  Eigen::Index size() const { return Eigen::Index{steps.count} * width; }
  Eigen::Index at(int substep) const { return Eigen::Index{substep - 1} * width; }  // from 1
};

/// The kinematic side meets the partner's moving surface as a one-body problem and returns the
/// complete reaction; the other side takes that reaction as impulses. Iterated is the Neumann
/// side's motion, never the force, so momentum is exact in every iterate  [M.9].
class Unilateral final : public Transmission {
 public:
  /// Trials are asked for where windows without them would miss `tolerance`; infinity: never.
  explicit Unilateral(double tolerance = 0.0) : tolerance_(tolerance) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return static_cast<int>(iterate_.size()); }
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

 private:
  Substeps kinematic_grid_;
  IterateGrid iterate_;                    // of the Neumann port
  std::vector<double> u_begin_, v_begin_;  // (width) of the Neumann port
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
  void find_inverse(const Joint& joint, double length);
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

/// The published form: motion (u, v, a) overwritten on the kinematic side, its internal force
/// handed to the other side. Iterated is the Neumann side's u, v and a  [M.14].
class DirichletNeumann final : public Transmission {
 public:
  /// `roles_swap`: what is the Neumann side now was the Dirichlet side of the window before.
  explicit DirichletNeumann(bool roles_swap) : roles_swap_(roles_swap) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return static_cast<int>(3 * iterate_.size()); }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const override { return r; }
  bool overwrites_motion() const override { return true; }
  bool ordered() const override { return true; }

 private:
  bool roles_swap_;
  IterateGrid iterate_;                              // of each of u, v and a
  std::vector<double> u_begin_, v_begin_, a_begin_;  // (width)
  // [N] (width) on the Neumann side, as exchanged at the end of the last window
  std::vector<double> f_begin_;
  ReferenceScales scale_;
};

}  // namespace abut
