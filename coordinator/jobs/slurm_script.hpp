#pragma once

#include <string>
#include <vector>

#include "coordinator/jobs/process_plan.hpp"

namespace abut {

/// What a job of Slurm is told beside the scene.
struct SlurmJob {
  std::string scene;                   // whole path
  std::string directory;               // whole path of the run's folder
  std::string programs;                // folder of abut and abut-solver, with a slash at its end
  std::vector<std::string> overrides;  // key.path=value
  std::vector<std::string> options;    // of sbatch, as "--time=2:00:00"
  bool again = false;                  // processes begin anew as long as there is a coordinator
};

/// The text of a script for sbatch: one allocation, a coordinator, and a step (srun) for each
/// process of bodies. Throws InputError for options that are none.
std::string slurm_script(const SlurmJob& job, const std::vector<ProcessPlan>& processes);

}  // namespace abut
