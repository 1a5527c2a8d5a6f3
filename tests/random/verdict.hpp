#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/random/random_scene.hpp"
#include "tests/random/trial_run.hpp"

namespace abut {

/// How a scene is run a second time, and what must be the same then.
enum class Again {
  fields,
  order,  // of bodies, interfaces and their sides
  finder,
  turned,
  moved,
  units,
  fast,
  processes,
  bodies,      // their order
  interfaces,  // their order, and that of their sides
  resumed,
};
const char* to_string(Again again);

/// What became of a random scene: of the run as it is and of the one that is as good.
struct Verdict {
  TrialRun run, other;
  Again again = Again::fields;
  double difference = 0.0;  // of velocities or energies between the two, over the most
  // The largest that starts make which differ by parts of 1e-9; asked where more differ than may.
  double sensitivity = 0.0;
  std::string trouble;      // empty: all is as it should be
  View view;                // of the run that is not
};

/// The scene of a seed; one in seven at 1000 m/s.
RandomScene scene_of(std::uint64_t seed);
/// Runs it, in a folder for its files.
Verdict judge(const RandomScene& scene, const std::filesystem::path& folder);
/// A line for people.
std::string line_of(const RandomScene& scene, const Verdict& verdict);

/// Counts over many seeds.
class Table {
 public:
  void add(const RandomScene& scene, const Verdict& verdict);
  std::string text() const;  // Markdown
  std::string sentence() const;

 private:
  struct Row {
    int scenes = 0, completed = 0, sound = 0;
    double passive = 0.0, growth = 0.0, momentum = 0.0, seconds = 0.0;
    std::vector<double> losses;  // of energy, in scenes of schemes that take none, as parts
  };
  struct Pairs {
    int scenes = 0, same = 0;
    std::vector<double> differences;
  };
  std::string losses() const;

  std::map<int, Row> rows_;  // by dimension
  std::map<Again, Pairs> again_;
  int unforetold_ = 0;  // pairs that may differ, as nearly the same starts do
};

double wall_seconds();

}  // namespace abut
