#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace abut {

/// What is seen of a random scene's run.
struct TrialRun {
  std::string status;     // completed, failed, interrupted, refused, or threw
  std::string reason;     // in words, where it is not completed
  double growth = 0.0;    // of energy that nobody gave, over the most that there was
  double loss = 0.0;      // of energy that nobody took or owes, at the end; below 0: growth
  double momentum = 0.0;  // largest change of their sum over the largest sum of their sizes
  double angular = 0.0;   // the same of the angular momentum; 0: a body does not tell it
  bool finite = true;
  std::vector<std::string> crossings;    // pairs of bodies whose outsides cross, and when
  std::vector<std::string> overlaps;     // pairs that the run told
  double passive = 0.0;                  // part of the windows
  double seconds = 0.0;                  // of the processor
  std::vector<std::uint64_t> hashes;     // by body
  double energy = 0.0, scale = 0.0;      // [J] kinetic and stored at the end, and the most of it
  double impulse = 0.0;                  // [N s] largest sum of sizes of momenta
  std::vector<Eigen::Vector3d> momenta;  // [N s] of bodies at the end, in the scene's order

  bool completed() const { return status == "completed"; }
  /// Why it is not as it should be; empty: it is. `free`: nothing outside acts on the bodies;
  /// `turns`: and their laws let them turn.
  std::string trouble(bool free, bool turns) const;
};

/// Where the bodies are: in this process, in one each, or in this one with a second coordinator and
/// new bodies from half of the time on.
enum class Where { here, processes, resumed };

/// Runs the scene of a folder, for at most so many seconds.
TrialRun try_run(const std::filesystem::path& folder, double patience, Where where = Where::here);

}  // namespace abut
