#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "base/archive.hpp"
#include "contract/substeps.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/convergence.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

class Tie;
class CompliantObstacle;

/// Exchanges that answer together (Net), by their own types.
struct KnownExchanges {
  template <class Own>
  struct Entry {
    const Joint* joint = nullptr;
    Own* exchange = nullptr;
    std::size_t part = 0;  // of the joints that were asked, in their order
  };
  std::vector<Entry<Tie>> ties;
  std::vector<Entry<CompliantObstacle>> obstacles;
};

/// What is known of the energy of bodies that exchange in some way.
enum class EnergyAccount {
  exact,    // every exchange of energy is reported
  unknown,  // motion is overwritten, or dashpots take what the sides cannot follow
  doubled,  // the bodies share material: it is there twice
};

/// What the partner's response imposes on each side of a closed joint, and what is iterated: values
/// at the substeps of a window, in SI units. A window runs  begin, predict, (impose side by side,
/// image, measure)*;  x is the joint's part of the stacked iterate.
class Exchange {
 public:
  virtual ~Exchange() = default;

  /// Tells the bodies whom their ports may meet, once, between windows, and numbers the partners.
  void introduce(Joint& joint, Bodies& bodies);
  /// When that was, among all joints of the run; none: not yet.
  std::optional<int> met() const { return met_; }

  /// Lays out the iterate of a window; the latest responses hold the state at its begin.
  virtual void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) = 0;
  virtual int values() const = 0;
  virtual void predict(Eigen::Ref<Eigen::VectorXd> x) const = 0;
  /// Fills the request of one side's body.
  virtual void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                      Bodies& bodies) = 0;
  /// G(x), out of the responses of this sweep.
  virtual void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                     const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) = 0;
  virtual FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                 const Eigen::Ref<const Eigen::VectorXd>& g) const = 0;
  /// Factors that make all entries of the iterate comparable: 1 / unit of each entry.
  virtual void scales(Eigen::Ref<Eigen::VectorXd> s) const = 0;
  /// Approximate J^-1 r, J = -d(G - x)/dx, from the port kernels, where it knows more than r.
  virtual Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const { return r; }
  /// Relaxation factor of a first correction, by impedance probe: stiffness of the Neumann side
  /// over that of both, each the inverse of its port kernel's first coefficient. 1 where one is not
  /// needed: what is iterated is scaled by the probe already, or the form is the published one.
  virtual double first_factor() const { return 1.0; }
  /// True when contact came or went within the window at the last image, and apply_inverse answers
  /// that exactly for linear bodies: secants of other substeps in contact would spoil it.
  virtual bool projects() const { return false; }
  /// True when the sides must be advanced one after the other, the kinematic one first.
  virtual bool ordered() const = 0;
  virtual EnergyAccount energy_account() const { return EnergyAccount::exact; }
  /// Enters itself under its own type where it answers together with others.
  virtual void enter(const Joint&, std::size_t /*part*/, KnownExchanges&) {}
  /// What it carries from window to window.
  virtual void state(Archive& archive) = 0;

 protected:
  ContactLaw law_;

 private:
  std::optional<int> met_;
};

/// All exchanges of these joints that answer together. They must outlive the list.
KnownExchanges known_exchanges(std::span<const Joint> joints);

/// By joint: whether its sides share one motion without rows of forces, as tied ends of bars do
/// that step alike.
std::vector<bool> share_nodes(std::span<const Joint> joints);

/// Values of a port at the ends of the substeps of a window: where they are in an iterate.
struct IterateGrid {
  Substeps steps;
  int width = 1;

  Eigen::Index size() const { return Eigen::Index{steps.count} * width; }
  Eigen::Index at(int substep) const { return Eigen::Index{substep - 1} * width; }  // from 1
};

}  // namespace abut
