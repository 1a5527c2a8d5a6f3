#pragma once

#include <memory>
#include <string>

#include <Eigen/Dense>

#include "coordinator/coupling/accelerator.hpp"
#include "coordinator/coupling/best_iterate.hpp"
#include "coordinator/coupling/net.hpp"

namespace abut {

/// The stacked iterate of an island in a window, and what the last sweep made of it.
struct Iterate {
  Eigen::VectorXd x, g, s;    // iterate, image, factors that make their entries comparable
  Eigen::VectorXd seen;       // last iterate that has an image
  int sweep = 0;              // from 1
  FieldResiduals residual;    // of the last sweep
  double mismatch = 0.0;      // the same, by units that only grow in a window
  bool converged = false;     // it is within the tolerance
  std::string contradiction;  // of ties, in words for people: no sweep makes it converge
};

/// Chooses the iterates of a window (docs/METHOD.md, the algorithm of section 3): Newton's step
/// where the net knows the Jacobian, else the accelerator's, with careful plain steps and returns
/// to the best iterate where contact makes its secants lead astray.
class Steps {
 public:
  static constexpr int usual_most = 20;
  /// Of bodies without inertia alone: what moves one as a whole comes from body to body, and
  /// shorter windows change nothing about it.
  static constexpr int usual_most_of_statics = 50;
  /// Secants have to learn what contact does to every joint of the bodies that it meets.
  static constexpr int usual_most_beside_ties = 40;

  struct Options {
    int max_iterations = usual_most;
    double tolerance = 1.0e-6;
  };
  /// For one window, which the net has begun.
  Steps(Net& net, Accelerator& accelerator, const Options& options, Bodies& bodies);

  /// Whether the iteration ends with the sweep that it saw last.
  bool enough(const Iterate& it) const;
  /// Replaces x by the next iterate.
  void next(Iterate& it, Bodies& bodies);
  /// True after `next` where the residual was within the tolerance and the step is too: a residual
  /// says little of how far forces are from those that fit where bodies hold each other.
  bool arrived(const Iterate& it) const;
  /// A body has no answer to x: goes back to a part of the plain step from the last iterate that
  /// had one. False: there is none.
  bool back(Iterate& it);

 private:
  /// Later it is no bad luck that the iteration has not ended.
  bool early(const Iterate& it) const { return 2 * it.sweep <= options_.max_iterations; }

  /// Secants have led away from the best iterate.
  bool astray(const Iterate& it);

  Net& net_;
  Accelerator& accelerator_;
  const Options options_;
  Inverses inverses_;
  const bool contracts_, beside_ties_, shared_;
  bool eased_ = false;     // contact knows what ties answer
  double mismatch_ = 0.0;  // of the sweep before
  int growths_ = 0;        // sweeps that the mismatch grew in
  double share_ = 1.0;     // of a plain step, when a body had no answer
  BestIterate best_;
  std::unique_ptr<Accelerator> careful_;
};

}  // namespace abut
