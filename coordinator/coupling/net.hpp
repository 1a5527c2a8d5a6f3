#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "contract/outcome.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/tie_net.hpp"

namespace abut {

/// The exchanges of an island as one: their iterates are parts of one stacked vector, and those
/// that answer together (ties, and surfaces that touch beside ties) are known by their own types.
class Net {
 public:
  /// `kernels`: port kernels answer contact that comes and goes.
  Net(const TieKernelOptions& ties, bool kernels) : tie_net_(ties), kernels_(kernels) {}
  virtual ~Net() = default;

  /// A window begins; island and joints must live as long as it does. The latest responses hold the
  /// state at its begin.
  void begin(const TimeWindow& window, const Island& island, std::span<const Joint> joints,
             Bodies& bodies);
  const Island& island() const { return *island_; }
  /// What it carries from window to window.
  virtual void state(Archive& archive) { tie_net_.state(archive); }
  Eigen::Index size() const { return first_.back(); }
  /// Tells window lengths and layouts of the iterate apart.
  std::uint64_t layout_key() const;

  // Of an iterate x (size), its image g and the factors s that make entries comparable:

  /// First guesses. Neumann sides whose flight without reactions is the guess are advanced and
  /// brought back.
  [[nodiscard]] std::optional<Failed> predict(Eigen::VectorXd& x, Bodies& bodies);
  /// Fills the requests of a level's bodies.
  void impose(std::size_t level, const Eigen::VectorXd& x, Bodies& bodies) const;
  /// g and s, out of the responses of a sweep.
  void image(const Eigen::VectorXd& x, const Bodies& bodies, Eigen::VectorXd& g,
             Eigen::VectorXd& s);
  /// By how much an image misses its iterate. Sweeps that went astray do not loosen the test.
  FieldResiduals residual(const Eigen::VectorXd& x, const Eigen::VectorXd& g) const;
  /// The largest difference of two stacked vectors, by units that only grow in a window, so that
  /// sweeps can be compared.
  double distance(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
  /// The change of forces that a difference of two stacked vectors makes where bodies have no
  /// inertia, as a part of what presses most in the last sweep; 0 elsewhere  [M.144].
  double force(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
  /// Ties that contradict each other, in words; empty: none do, or the sweep does not show it.
  /// `stays_open`: what meshes leave of motions that are given to both sides is not measured.
  std::string contradiction(const Eigen::VectorXd& r, double tolerance, const Bodies& bodies,
                            bool& stays_open) const;

  // Of a residual r = g - x:

  /// What the joints know of the inverse of the Jacobian J = -d(G - x)/dx, on r.
  Eigen::VectorXd inverse(const Eigen::VectorXd& r) const;
  /// r, that of every joint relaxed by its first factor.
  Eigen::VectorXd relaxed(const Eigen::VectorXd& r) const;

  // How the iteration may go:

  /// Plain steps contract: all joints are contact of surfaces, or this and ties. What a kernel of
  /// ties lets give way, contact only holds.
  bool contracts() const;
  /// The same, with ties.
  bool contact_beside_ties() const { return contracts() && !known_.ties.empty(); }
  /// Some obstacle gives way by a kernel of near points alone.
  bool leaves_out() const;
  /// Bodies have several of the joints.
  bool shares_bodies() const { return !island_->shared.empty(); }
  /// The inverse answers the last image exactly: points came into contact or left it.
  bool projects() const;
  /// Tells contact how ties answer it, where that is known exactly: each contact has a net of its
  /// own, of linear bodies that step alike. Then a plain step is Newton's. False: secants are
  /// needed.
  bool ease(Bodies& bodies);
  void withdraw(Bodies& bodies);
  /// After a sweep: bodies without inertia that are not linear tell anew how they give way. True:
  /// the inverse is the derivative at this sweep. False: `g` is the image that is iterated.
  virtual bool renew(const Eigen::VectorXd& /*x*/, Eigen::VectorXd& /*g*/, Bodies& bodies) {
    return tie_net_.renew(bodies);
  }

 protected:
  /// A window begins: all know where their parts of a stacked vector begin.
  virtual void begin_ties(const KnownExchanges& known, std::span<const Eigen::Index> first,
                          Bodies& bodies) {
    tie_net_.begin(known, first, bodies);
  }

 private:
  std::size_t count() const { return island_->joints.size(); }
  const Joint& joint(std::size_t part) const { return joints_[island_->joints[part]]; }
  Exchange& exchange(std::size_t part) const { return *joint(part).exchange; }
  template <class V>
  auto part(V& v, std::size_t i) const {
    return v.segment(first_[i], first_[i + 1] - first_[i]);
  }
  bool flies(const Island::End& end) const;
  std::vector<int> release(std::size_t level, const Eigen::VectorXd& x, Bodies& bodies) const;

  TieNet tie_net_;
  bool kernels_;
  // Of a window:
  const Island* island_ = nullptr;
  std::span<const Joint> joints_;
  TimeWindow window_;
  std::vector<Eigen::Index> first_;  // of every joint's part in the stacked iterate, and the total
  KnownExchanges known_;
  std::vector<CompliantObstacle*> obstacles_;  // by part; null: something else
};

}  // namespace abut
