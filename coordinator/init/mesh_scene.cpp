#include "coordinator/init/mesh_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/count.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/yaml_document.hpp"
#include "coordinator/init/mesh_row.hpp"
#include "coordinator/scene.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr double speed = 10.0;        // [m/s] of the first body
constexpr double wave_speed = 6.0e3;  // [m/s] of steel, the material that is written
constexpr double of_limit = 0.8;      // of the stable step: strain lowers it
constexpr int window_steps = 4;       // of the body with the longest ones
constexpr double transits = 10.0;     // of the longest body, from the first touch to the end
constexpr double pictures = 50.0;     // of a run
/// For large rotations where it is cheap: quadratic cells are not found in batches.
std::string law_of(const RowBody& body) {
  return body.quadratic ? "steel" : "{neo_hookean: steel}";
}

struct Times {
  std::vector<double> steps;  // [s] one per body
  double window = 0.0, end = 0.0;
  int every = 1;  // windows from one picture to the next
};

/// With two digits, so that people can read it, and not above.
double rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit) * unit;
}

/// Least number of parts, of which a window has short decimals, that are at most so long.
int parts_of(double window, double longest) {
  for (int count = 1; count < 1'000'000; ++count) {
    int rest = count;
    for (const int prime : {2, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1 && window / count <= longest) return count;
  }
  throw InputError("needs more than a million steps in a window", "--from mesh",
                   "Mesh the bodies with cells of more equal size.");
}

std::string material_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : ElasticSpec::presets()) names.push_back(preset.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string list(const std::vector<double>& values) {
  return fmt::format("[{:.9g}]", fmt::join(values, ", "));
}

/// What no reader of YAML takes for anything but text.
std::string quoted(const std::string& name) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '/' || c == '.';
  };
  const bool word = name != "null" && std::all_of(name.begin(), name.end(), plain);
  return word ? name : fmt::format("\"{}\"", name);
}

class SceneWriter {
 public:
  /// `whole_paths`: of meshes; else they are relative to the scene's folder.
  SceneWriter(const fs::path& scene, const MeshRow& row, bool whole_paths)
      : scene_(scene), row_(row), whole_paths_(whole_paths) {}

  std::string text(const Times& times) const {
    std::string out = head();
    out += "units: SI   # of numbers; others may have units of their own, as 5 mm\n";
    out += fmt::format("meta: {{title: {}}}\n", title());
    out += fmt::format(
        "time: {{begin: 0.0, end: {:.9g}, window: {:.9g}}}   # [s] bodies are coupled once per "
        "window\n",
        times.end, times.window);
    out += "bodies:\n";
    for (std::size_t i = 0; i < row_.bodies.size(); ++i) out += body(i, times.steps[i]);
    if (row_.wall) out += wall();
    out += "interfaces:\n";
    for (std::size_t i = 0; i + 1 < row_.bodies.size(); ++i)
      out += interface(row_.bodies[i].name, row_.bodies[i + 1].name + ".skin");
    if (row_.wall) out += interface(row_.bodies[0].name, "wall.face");
    out += fmt::format("output: {{fields: {{every: {}}}}}   # pictures, every so many windows\n",
                       times.every);
    return out;
  }

 private:
  std::string title() const {
    const std::string& first = row_.bodies[0].name;
    return row_.wall ? first + " hits a rigid wall"
                     : fmt::format("{} hits {}", first, row_.bodies[1].name);
  }

  std::string head() const {
    return fmt::format(
        "# {}. Made of {} by `abut init`; speeds, materials, places and friction are yours to "
        "change.\n"
        "# `abut reference KEY` tells every key, as `abut reference bodies.b.material`, and so "
        "does docs/REFERENCE.md.\n#\n"
        "#   abut check {}     valid? what will it pay for?\n"
        "#   abut run {}       into runs/{}; ParaView opens fields.pvd there\n"
        "#   abut report runs/{}     a page of plots\n",
        title(), row_.bodies.size() == 1 ? "a mesh file" : "mesh files", scene_.string(),
        scene_.string(), scene_.stem().string(), scene_.stem().string());
  }

  std::string path_to(const fs::path& mesh) const {
    if (whole_paths_) return fs::absolute(mesh).string();
    const fs::path folder = fs::absolute(scene_).parent_path();
    return fs::absolute(mesh)
        .lexically_normal()
        .lexically_relative(folder.lexically_normal())
        .string();
  }

  std::string body(std::size_t i, double step) const {
    const RowBody& one = row_.bodies[i];
    std::vector<double> velocity(index(row_.dim), 0.0);
    if (i == 0) velocity[0] = speed;
    std::string out = fmt::format("  {}:   # {}\n", one.name, one.words());
    out += fmt::format(
        "    model: {{fe: {{dimension: {}, {}mesh: {{{}: {{file: {}, scale: {}}}}}}}}}   # the "
        "file's unit\n",
        row_.dim, row_.dim == 2 ? "plane: strain, " : "", one.reader, quoted(path_to(one.file)),
        row_.scale == 1.0 ? "1 m" : "1 mm");
    out += fmt::format("    material: {}   # there are {}\n", law_of(one), material_names());
    out += fmt::format(
        "    integrator: {{central_difference: {{step: {:.9g}, above_limit: clamp}}}}   # [s]\n",
        step);
    out += fmt::format(
        "    initial: {{position: {}, velocity: {}}}   # [m] of the file's origin, [m/s]\n",
        list(one.position), list(velocity));
    out += "    ports:\n      skin: boundary   # all of its surface\n";
    for (const auto& [port, side] : one.ports)
      out += fmt::format("      {}: {}\n", port, quoted(side));
    if (!one.node_sets.empty())
      out +=
          fmt::format("    # sets of nodes, for constraints: {}\n", fmt::join(one.node_sets, ", "));
    return out;
  }

  std::string wall() const {
    const RowWall& wall = *row_.wall;
    const bool flat = row_.dim == 2;
    return fmt::format(
        "  wall:\n    model: {{rigid_tool: {{dimension: {}, mesh: {{{}: {{lengths: {}, elements: "
        "{}}}}}}}}}\n"
        "    initial: {{position: {}}}\n    ports: {{face: left}}\n",
        row_.dim, flat ? "rectangle" : "box", list(wall.lengths), flat ? "[1, 1]" : "[1, 1, 1]",
        list(wall.position));
  }

  static std::string interface(const std::string& body, const std::string& other) {
    return fmt::format(
        "  {}_{}:\n    sides: [{}.skin, {}]\n    contact: {{friction: 0.2}}   # Coulomb's "
        "coefficient\n",
        body, split_port(other).body, body, other);
  }

  const fs::path& scene_;
  const MeshRow& row_;
  bool whole_paths_;
};

/// [s] Limits of the bodies' steps, as the bodies themselves tell them. The scene's folder may not
/// be there yet.
std::vector<double> stable_steps(const fs::path& scene, const MeshRow& row) {
  const SceneWriter writer(scene, row, true);
  Times small;
  small.steps.assign(row.bodies.size(), 1.0e-15);
  small.window = 1.0e-15;
  small.end = 1.0e-14;
  const Document document = Document::from_text(scene.string(), writer.text(small));
  const Scene read = read_scene(document);
  std::vector<double> limits;
  for (std::size_t i = 0; i < row.bodies.size(); ++i) {
    const auto& [name, entry] = read.bodies[i];
    limits.push_back(make_body(document, "bodies." + name, entry.context)->describe().stable_step);
  }
  return limits;
}

Times times_of(const MeshRow& row, const std::vector<double>& limits) {
  Times times;
  const double longest = *std::max_element(limits.begin(), limits.end());
  const double coarse = rounded_down(of_limit * longest);
  times.window = window_steps * coarse;
  for (const double limit : limits)
    times.steps.push_back(times.window / parts_of(times.window, of_limit * limit));
  const double touch = row.first_gap / speed;
  const double windows = std::ceil((touch + transits * row.longest / wave_speed) / times.window);
  times.end = windows * times.window;
  times.every = count_within(std::floor(windows / pictures), 1, std::numeric_limits<int>::max());
  return times;
}

}  // namespace

MeshScene mesh_scene(const fs::path& scene, const std::vector<std::string>& meshes) {
  const MeshRow row = mesh_row(meshes);
  const SceneWriter writer(scene, row, false);
  const Times times = times_of(row, stable_steps(scene, row));
  MeshScene out;
  out.text = writer.text(times);
  for (const RowBody& body : row.bodies) {
    out.words.push_back(fmt::format("{}: {}", body.name, body.words()));
    for (const std::string& note : body.notes)
      out.words.push_back(fmt::format("{}: {}", body.name, note));
  }
  return out;
}

}  // namespace abut
