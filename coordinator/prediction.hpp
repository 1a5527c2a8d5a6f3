#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/probed_run.hpp"

namespace abut {

/// What a run will take, told from a probe.
struct Prediction {
  double seconds = 0.0;          // most likely
  double low = 0.0, high = 0.0;  // as little, as much of what is to come is in contact
  bool exact = false;            // the probe was the whole run
};

/// What is known of contact beside what the probe has seen.
struct ContactOutlook {
  bool possible = false;  // sides may meet that are not tied
  bool tied = false;      // every window is iterated
  bool lasting = false;   // something presses: loads, weight, statics, tools
  int sweeps = 1;         // most iterations of a window on average
};

/// `end` [s]: of the scene; `startup` [s]: until the first window. Nothing: not one window ended.
std::optional<Prediction> predict(const ProbedRun& probe, double end, double startup,
                                  const ContactOutlook& outlook);

/// What makes the run dear: bodies by their share, the largest first, and the coupling, in words.
std::string dear_words(const ProbedRun& probe, std::span<const std::string> bodies);

/// For people, lines of a table of `abut check`. `memory_mib`: of all processes.
std::string to_text(const Prediction& prediction, const ProbedRun& probe, double end,
                    double memory_mib, std::size_t processes);

}  // namespace abut
