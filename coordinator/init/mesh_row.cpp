#include "coordinator/init/mesh_row.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_errors.hpp"
#include "coordinator/init/facing_distance.hpp"
#include "subdomain_solver/fe/abaqus_file.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr double largest_in_metres = 5.0;  // a part whose numbers are larger is in millimetres
constexpr double gap = 3.0e-3;             // between boxes, of the longest edge

/// Corners of the box around a mesh, in the file's unit.
struct Box {
  std::array<double, 3> low{}, high{};
  double length(std::size_t d) const { return high[d] - low[d]; }
  double middle(std::size_t d) const { return 0.5 * (low[d] + high[d]); }
};

Box box_of(const Mesh& mesh) {
  Box box;
  const std::size_t dim = index(mesh.dim);
  for (std::size_t d = 0; d < dim; ++d) {
    box.low[d] = box.high[d] = mesh.points[d];
    for (std::size_t i = d; i < mesh.points.size(); i += dim) {
      box.low[d] = std::min(box.low[d], mesh.points[i]);
      box.high[d] = std::max(box.high[d], mesh.points[i]);
    }
  }
  return box;
}

/// A name of letters, digits and _ that the list does not have yet.
std::string fresh_name(const std::string& text, const std::vector<std::string>& taken) {
  std::string name;
  for (const char letter : text)
    name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  if (name.empty()) name = "body";
  const std::string stem = name;
  for (int k = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++k)
    name = fmt::format("{}_{}", stem, k);
  return name;
}

std::string cell_words(const Mesh& mesh) {
  std::map<std::string, int> counts;
  for (const CellBlock& block : mesh.blocks)
    counts[std::string(block.element->name)] += block.count();
  std::vector<std::string> words;
  for (const auto& [element, count] : counts) words.push_back(fmt::format("{} {}", count, element));
  return fmt::format("{}", fmt::join(words, ", "));
}

bool is_abaqus(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& letter : ending)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return ending == ".inp";
}

RowBody body_of(const Mesh& mesh, const fs::path& file, std::vector<std::string>& taken) {
  RowBody body;
  body.name = fresh_name(file.stem().string(), taken);
  taken.push_back(body.name);
  body.file = file;
  body.reader = is_abaqus(file) ? "abaqus" : "gmsh";
  body.nodes = mesh.node_count();
  body.cells = cell_words(mesh);
  body.quadratic = std::ranges::any_of(
      mesh.blocks, [](const CellBlock& block) { return block.element->order > 1; });
  std::vector<std::string> ports = {"skin"};
  for (const auto& [side, facets] : mesh.sides) {
    if (side == "boundary") continue;
    body.ports.emplace_back(fresh_name(side, ports), side);
    ports.push_back(body.ports.back().first);
  }
  for (const auto& set : mesh.node_sets) {
    const std::string& name = set.first;
    const auto block = [&name](const CellBlock& one) { return one.name == name; };
    if (!mesh.sides.contains(name) && std::none_of(mesh.blocks.begin(), mesh.blocks.end(), block))
      body.node_sets.push_back(name);
  }
  return body;
}

/// `notes`: of each file.
std::vector<Mesh> meshes_of(const std::vector<std::string>& files,
                            std::vector<std::vector<std::string>>& notes) {
  std::vector<Mesh> meshes;
  InputErrors errors;
  for (const std::string& file : files) {
    notes.emplace_back();
    errors.gather([&] {
      meshes.push_back(is_abaqus(file) ? read_abaqus(file, 1.0, "", 0, &notes.back())
                                       : read_gmsh(file, 1.0, 0, &notes.back()));
    });
  }
  errors.raise();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].dim < 2)
      throw InputError("is a mesh of lines", files[i],
                       "Give meshes of areas or volumes; abut init NAME --from bars writes bars.");
    if (meshes[i].dim != meshes[0].dim)
      throw InputError(
          fmt::format("has {} dimensions, but {} has {}", meshes[i].dim, files[0], meshes[0].dim),
          files[i], "Give meshes of the same dimension.");
  }
  return meshes;
}

}  // namespace

std::string RowBody::words() const {
  return fmt::format("{} nodes, {}, {:.4g} m", nodes, cells, fmt::join(lengths, " x "));
}

MeshRow mesh_row(const std::vector<std::string>& files) {
  std::vector<std::vector<std::string>> notes;
  const std::vector<Mesh> meshes = meshes_of(files, notes);
  MeshRow row;
  row.dim = meshes[0].dim;
  const std::size_t dim = index(row.dim);
  std::vector<Box> boxes;
  double longest = 0.0;
  for (const Mesh& mesh : meshes) {
    boxes.push_back(box_of(mesh));
    for (std::size_t d = 0; d < dim; ++d) longest = std::max(longest, boxes.back().length(d));
  }
  row.scale = longest > largest_in_metres ? 1.0e-3 : 1.0;
  row.longest = row.scale * longest;
  std::vector<std::string> names = {"wall"};
  double front = row.scale * boxes[0].low[0];  // where the next body may begin
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    RowBody body = body_of(meshes[i], files[i], names);
    body.notes = std::move(notes[i]);
    for (std::size_t d = 0; d < dim; ++d) {
      body.lengths.push_back(row.scale * boxes[i].length(d));
      body.position.push_back(row.scale * (boxes[0].middle(d) - boxes[i].middle(d)));
    }
    body.position[0] = front - row.scale * boxes[i].low[0];
    front += body.lengths[0] + gap * row.longest;
    row.bodies.push_back(std::move(body));
  }
  row.first_gap = gap * row.longest;
  if (meshes.size() > 1) {
    const auto surface = [&](std::size_t i) {
      return placed_surface(meshes[i], row.bodies[i].position, row.scale);
    };
    const double way = facing_distance(surface(0), surface(1));
    if (std::isfinite(way)) row.first_gap = way;
    return row;
  }
  RowWall wall;
  wall.lengths = {0.1 * row.longest};
  wall.position = {front};
  for (std::size_t d = 1; d < dim; ++d) {
    wall.lengths.push_back(1.5 * row.longest);
    wall.position.push_back(row.scale * boxes[0].middle(d) - 0.75 * row.longest);
  }
  row.wall = std::move(wall);
  return row;
}

}  // namespace abut
