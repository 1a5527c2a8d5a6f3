#pragma once

#include <array>
#include <vector>

#include "coordinator/coupling/exchange.hpp"

namespace abut {

/// Robin conditions on both sides (impedance transmission): a side takes its partner's contact
/// force plus impedance x the rate at which both close in, so that it meets a dashpot instead of a
/// wall or a force. Iterated is what comes in: the partner's force and its part of the closing
/// rate, as one force q at the partner's substeps. In the parallel form both sides' q.
///
/// Conditions on velocities keep any gap that is there at the begin: the first substep closes it.
class Robin final : public Exchange {
 public:
  enum class Rule { matched, kernel, given };

  /// `impedance` [kg/s] of Rule::given.
  Robin(Rule rule, double impedance, bool parallel)
      : rule_(rule), given_(impedance), parallel_(parallel) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override;
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  bool ordered() const override { return !parallel_; }
  void state(Archive& archive) override;

 private:
  /// What is known of a side at the window's begin; displacements along its outward normal.
  struct Begin {
    Substeps grid;  // of what it sends
    ForceSupport support = ForceSupport::nodal;
    double v = 0.0, force = 0.0;   // [m/s] [N] compressive
    double impedance = 0.0;        // [kg/s] that this side sees
    std::vector<double> incoming;  // [N] last q of this side: the guess of a shorter window
    double incoming_begin = 0.0;   // [s] begin of its window
  };
  /// Sides whose incoming force is iterated, in the order of the iterate.
  std::array<int, 2> iterated() const;
  int parts() const { return parallel_ ? 2 : 1; }
  const Begin& partner(int side) const { return sides_[1 - side]; }
  void find_impedances(const Joint& joint, Bodies& bodies);
  /// q for a side out of its partner's latest response.
  void outgoing(int side, const Joint& joint, const Bodies& bodies,
                Eigen::Ref<Eigen::VectorXd> q) const;

  Rule rule_;
  double given_;
  bool parallel_;
  int kinematic_ = 0;
  std::array<Begin, 2> sides_;
  double overlap_ = 0.0;  // [m] at the window's begin
  double impedance_sum_ = 0.0;
  ReferenceScales scale_;
};

}  // namespace abut
