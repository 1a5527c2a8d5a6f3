#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace abut {

/// What `abut init` is asked for.
struct InitOptions {
  std::string name;                 // of the scene's file, with or without .yaml
  std::string from;                 // bars, contact, friction, joined, study, mesh or gmsh
  std::vector<std::string> meshes;  // of mesh and gmsh
};

/// Files that are to be written, the scene the first, and what to tell of them.
struct InitFiles {
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  std::vector<std::string> words;  // lines
};

/// A commented scene that runs as it is. Throws InputError.
InitFiles init_files(const InitOptions& options);

}  // namespace abut
