#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abut {

struct MeshScene {
  std::string text;
  std::vector<std::string> words;  // lines on each body
};

/// A scene with a body per mesh file: the first flies towards the second, and so on in a row along
/// x; a body alone flies towards a rigid wall. Places keep the bodies' boxes apart, steps are below
/// the limits of the bodies, and the run ends when waves have crossed the bodies several times
/// after the first touch. `scene`: its path, to which the meshes' paths are written relative.
/// Throws InputError.
MeshScene mesh_scene(const std::filesystem::path& scene, const std::vector<std::string>& meshes);

}  // namespace abut
