#pragma once

#include <optional>
#include <string>

#include "base/awaited.hpp"
#include "base/clock.hpp"
#include "base/yaml_document.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/verbs/placed_scene.hpp"

namespace abut {

/// A scene that can be run: read, placed and found valid.
struct RunPlan {
  Document document;
  Scene scene;
  Placement placement;
  Validated valid;
};

struct RunOptions {
  bool local = false;
  bool quiet = false;
  bool insecure = false;           // bodies without keys may come from other machines
  bool trace = false;              // its wall time is told in trace.json
  unsigned grace = 10;             // [s] for the window under way, where a signal ends the run
  Clock::Time began;               // of the program
  std::optional<Awaited> awaited;  // absent: processes come to life as the scene says
};

/// Reads a scene, with all stages that follow, and places its bodies. `begin`: [s] of a stage that
/// follows one that an event may have ended; none: the scene's. Throws InputError, RunError.
RunPlan plan_run(Document document, const RunOptions& options, const Interrupts& interrupts,
                 std::optional<double> begin = std::nullopt);

/// Bodies of which the stage that follows a scene has another model or mesh; none: no stage
/// follows.
std::vector<std::string> swapped_bodies(const Document& document);

/// The resolved scene, with who has read it.
std::string resolved_text(const Scene& scene, const Document& document);

/// Runs the scene and the stages that follow it, from its begin or from a checkpoint of this
/// directory: writes all files, and prints the result. The exit code of the verb. Where a body is
/// lost and the scene says so, all bodies begin again from the latest checkpoint. Throws
/// InputError, RunError.
int record_run(RunPlan plan, const RunOptions& options, RunDirectory& held,
               const Interrupts& interrupts, std::optional<Checkpoint> from);

}  // namespace abut
