#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/coupling/accelerator.hpp"
#include "coordinator/coupling/best_iterate.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/convergence.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/coupling/tie_net.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

struct SchwarzReport {
  bool converged = false;
  int iterations = 0;         // sweeps: every body of the island advanced once in each
  FieldResiduals residual;    // of the last sweep
  std::string contradiction;  // of ties, in words for people: no sweep makes it converge
};

/// The alternating Schwarz iteration of one window.
class Schwarz {
 public:
  struct Options {
    int max_iterations = 20;
    double tolerance = 1.0e-6;
    bool kernels =
        true;  // the accelerator uses port kernels: they answer contact that comes and goes
    TieKernelOptions ties = {};
  };
  /// Of the inverse Jacobian and of the probed relaxation factors.
  using MakeAccelerator = std::function<std::unique_ptr<Accelerator>(ApplyInverse, ApplyInverse)>;

  Schwarz(const Options& options, MakeAccelerator make)
      : options_(options), make_(std::move(make)) {}

  /// Iterates an island over a window until its sides agree. Before, its bodies are saved at the
  /// window's begin and the requests are prepared; afterwards they stand at its end, all of the
  /// same sweep. Reaching the cap is a report, never a success.
  [[nodiscard]] std::variant<SchwarzReport, Failed> solve(const TimeWindow& window,
                                                          const Island& island,
                                                          std::span<const Joint> joints,
                                                          Bodies& bodies);
  /// These are the islands now: those of long ago are forgotten.
  void keep(std::span<const Island> islands);
  /// The window was accepted.
  void accept(const Island& island);

 private:
  struct Layout {
    std::vector<int> joints;
    std::vector<Eigen::Index> first;  // of every joint's part in the stacked iterate, and the total
  };
  void lay_out(const TimeWindow& window, const Island& island, std::span<const Joint> joints,
               Bodies& bodies);
  /// First guesses of all joints.
  std::optional<Failed> fly(const Island& island, std::span<const Joint> joints, Bodies& bodies);
  std::optional<Failed> sweep(const Island& island, std::span<const Joint> joints,
                              const Layout& layout, const Eigen::VectorXd& x, Bodies& bodies) const;
  /// Images of the iterate, out of the responses of a sweep, and by how much they miss it: its
  /// residual, and the largest mismatch by units that only grow in a window, so that sweeps can be
  /// compared.
  double see_images(std::span<const Joint> joints, const Bodies& bodies, FieldResiduals& residual);
  FieldResiduals residual_of(std::span<const Joint> joints);
  bool projected(std::span<const Joint> joints) const;
  /// How the iteration of a window goes.
  struct Course {
    bool contracts = false, shared = false;  // contact; with bodies of several joints
    bool tied = false;                       // beside ties
    bool eased = false;                      // whose answer to contact is known
    bool early = true, grows = false;        // of the last sweep
    double share = 1.0;                      // of a plain step
    double mismatch = 0.0;
    int growths = 0;  // of the mismatch
    BestIterate best;
    std::unique_ptr<Accelerator> careful;
  };
  bool contracts(const Island& island, std::span<const Joint> joints) const;
  bool ease(const Island& island, std::span<const Joint> joints, Bodies& bodies);
  void withdraw(const Island& island, std::span<const Joint> joints, Bodies& bodies);
  void step_back(Course& course, std::span<const Joint> joints, Accelerator& accelerator);
  void step(Course& course, std::span<const Joint> joints, Bodies& bodies,
            Accelerator& accelerator);
  double step_from(const Eigen::VectorXd& before, std::span<const Joint> joints);
  /// The residual, of every joint relaxed by its first factor.
  Eigen::VectorXd relaxed(Eigen::VectorXd r, std::span<const Joint> joints) const;
  /// A joint's part of a stacked vector.
  Eigen::VectorBlock<Eigen::VectorXd> part(Eigen::VectorXd& v, std::size_t i) const {
    return v.segment(layout_.first[i], layout_.first[i + 1] - layout_.first[i]);
  }
  /// What the joints know of the inverse of the Jacobian, on a plain residual g - x.
  Eigen::VectorXd inverse_of(const Eigen::VectorXd& r, std::span<const Joint> joints) const;
  Accelerator& accelerator_of(const Island& island);

  Options options_;
  MakeAccelerator make_;
  // iterate, image, scales, last iterate that has an image: kept, so that windows allocate nothing
  Eigen::VectorXd x_, g_, s_, held_;
  // of the window being solved: the accelerators' inverse reads them
  Layout layout_;
  std::span<const Joint> joints_;
  struct Memory {  // of an island
    std::unique_ptr<Accelerator> accelerator;
    std::unique_ptr<TieNet> ties;
  };
  TieNet* ties_ = nullptr;  // of the window being solved
  std::map<std::vector<int>, Memory> memories_;
};

}  // namespace abut
