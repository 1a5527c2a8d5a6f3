#pragma once

#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// A process of bodies, as a batch system starts it.
struct ProcessPlan {
  std::string name;     // by which its keys go
  std::string program;  // of somebody else; empty: abut-solver
  std::vector<std::string> bodies;
  int threads = 1;  // the most that a body of it has

  /// Words after the program that say which bodies it is.
  std::vector<std::string> words() const;
};

/// All processes of a run. Throws InputErrorList: bodies of a program that nobody names, and names
/// that can have no keys.
std::vector<ProcessPlan> plan_processes(const Scene& scene, const Document& document);

/// A file that a body's mesh is read from.
struct MeshFile {
  std::string key;   // key path
  std::string file;  // from where this process is
};

/// Of all bodies, in the scene's order; copies have theirs once. Throws InputError where copies
/// stand in a table, which is another file.
std::vector<MeshFile> mesh_files(const Scene& scene, const Document& document);

/// By which name a batch system knows a run: "two_bars" of configs/two_bars.yaml.
std::string job_name(const std::string& scene_path);

}  // namespace abut
