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
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/coupling/net.hpp"
#include "coordinator/coupling/steps.hpp"

namespace abut {

struct SchwarzReport {
  bool converged = false;
  int iterations = 0;         // sweeps: every body of the island advanced once in each
  FieldResiduals residual;    // of the last sweep
  bool beside_ties = false;   // contact presses on bodies that are joined
  std::string contradiction;  // of ties, in words for people: no sweep makes it converge
};

/// The alternating Schwarz iteration of one window.
class Schwarz {
 public:
  struct Memory {  // of an island, from window to window
    std::unique_ptr<Accelerator> accelerator;
    std::unique_ptr<Net> net;
  };
  /// For the joints of an island, by their numbers in the run.
  using Make = std::function<Memory(std::span<const int> joints)>;

  /// `most` iterations of a window; absent: the usual ones (Steps).
  Schwarz(std::optional<int> most, double tolerance, Make make)
      : most_(most), tolerance_(tolerance), make_(std::move(make)) {}

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
  /// What it has learned of all islands, between windows.
  void state(Archive& archive);

 private:
  Memory& memory_of(const std::vector<int>& joints);
  /// Every body of the island advances once, level by level.
  std::optional<Failed> sweep(Net& net, Bodies& bodies);
  /// What the sweep made of the iterate.
  void see(Net& net, const Bodies& bodies);

  std::optional<int> most_;
  double tolerance_;
  Make make_;
  Iterate it_;  // kept, so that windows allocate nothing
  std::map<std::vector<int>, Memory> memories_;
};

}  // namespace abut
