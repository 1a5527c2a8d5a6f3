#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

struct SplitOptions {
  int bodies = 2;
  std::string body;           // empty: the only one that can be divided
  std::filesystem::path out;  // folder of the new files, which paths in them start from
};

/// A scene of which one body is divided into tied ones, as files. The same scene gives the same
/// bytes.
struct SplitScene {
  std::string scene;  // what the whole scene says, of the parts, as YAML
  std::vector<std::pair<std::string, std::string>> meshes;  // names and texts of files beside it
  std::vector<std::string> parts;                           // for people: what became of the body
  // measures of expectations that nothing has now, and why
  std::vector<std::pair<std::string, std::string>> left_out;
};

/// Divides the mesh of one finite element body of two or three dimensions into connected parts of
/// about equal numbers of cells. Each part is a body with the keys of the whole and those of its
/// ports, points, constraints and loads that reach into it; parts that share facets are tied there.
/// Interfaces of the whole become one for every part that has facets of the port; ports that may
/// touch lie in one part. A body that was alone gets windows of one step. Throws
/// InputError: no such body, one that has no cells to deal out.
SplitScene split_scene(const Document& document, const Scene& scene, const SplitOptions& options);

}  // namespace abut
