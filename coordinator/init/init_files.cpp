#include "coordinator/init/init_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.hpp"
#include "coordinator/init/mesh_scene.hpp"
#include "coordinator/init/templates.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kinds = {"bars",  "contact", "friction", "joined",
                                                   "study", "mesh",    "gmsh"};

fs::path scene_path(const std::string& name) {
  fs::path path = name;
  if (path.extension() != ".yaml" && path.extension() != ".yml") path += ".yaml";
  if (path.stem().empty() || path.stem() == ".yaml")
    throw InputError("names no file", name, "Give the scene a name, such as mine.");
  return path;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// `scene`: the file that a study is of.
std::string filled(std::string_view name, const fs::path& path, const fs::path& scene) {
  std::string text(template_text(name));
  replace_all(text, "@file@", path.string());
  replace_all(text, "@stem@", path.stem().string());
  replace_all(text, "@scene@", scene.filename().string());
  return text;
}

}  // namespace

InitFiles init_files(const InitOptions& options) {
  if (std::find(kinds.begin(), kinds.end(), options.from) == kinds.end())
    throw InputError(fmt::format("is {}, which is not known", options.from), "--from",
                     fmt::format("Choose one of {}.", fmt::join(kinds, ", ")));
  const bool meshed = options.from == "mesh" || options.from == "gmsh";
  if (meshed && options.meshes.empty())
    throw InputError(
        "names no mesh", "--from " + options.from,
        "Give one .msh or .inp file or several: abut init NAME --from mesh a.msh b.inp.");
  if (!meshed && !options.meshes.empty())
    throw InputError("is more than the scene's name", options.meshes.front(),
                     "Give a single name; meshes belong to --from mesh.");
  const fs::path scene = scene_path(options.name);
  if (meshed) {
    MeshScene made = mesh_scene(scene, options.meshes);
    return {{{scene, std::move(made.text)}}, std::move(made.words)};
  }
  InitFiles out;
  const bool study = options.from == "study";
  out.files.emplace_back(scene, filled(study ? "bars" : options.from, scene, scene));
  if (study) {
    const fs::path file = scene.parent_path() / (scene.stem().string() + "_study.yaml");
    out.files.emplace_back(file, filled("study", file, scene));
  }
  return out;
}

}  // namespace abut
