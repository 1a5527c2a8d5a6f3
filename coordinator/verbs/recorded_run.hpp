#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "base/clock.hpp"
#include "base/yaml_document.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/verbs/placed_scene.hpp"

namespace abut {

/// A scene that is run, and where it leaves what it tells.
struct RunPlan {
  const Document& document;
  const Scene& scene;
  std::filesystem::path directory;  // locked for this run
  std::string resolved;             // scene.resolved.yaml
  bool local = false;
  bool quiet = false;
  Clock::Time began;  // of the program
};

/// The resolved scene, with who has read it.
std::string resolved_text(const Scene& scene, const Document& document);

/// Runs the scene from its begin, or from a checkpoint of this directory, to its end, writes all
/// files and prints the result. The exit code of the verb. Throws InputError, RunError.
int record_run(const RunPlan& plan, Placement& placement, const Validated& valid,
               const Interrupts& interrupts, const Checkpoint* from);

}  // namespace abut
