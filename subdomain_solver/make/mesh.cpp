#include "subdomain_solver/make/mesh.hpp"

#include "subdomain_solver/make/expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/count.hpp"
#include "base/counted.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/abaqus_file.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"
#include "subdomain_solver/fe/file_digest.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"

namespace abut {

namespace {

template <std::size_t N>
std::array<double, N> array_of(const std::vector<double>& list) {
  std::array<double, N> out{};
  std::copy_n(list.begin(), N, out.begin());
  return out;
}

template <std::size_t N>
std::array<int, N> counts_of(const std::vector<double>& list) {
  std::array<int, N> out{};
  std::transform(list.begin(), list.end(), out.begin(),
                 [](double x) { return count_within(x, 0, std::numeric_limits<int>::max()); });
  return out;
}

Origin origin_of(bool centred) { return centred ? Origin::centre : Origin::corner; }

/// An error of the mesh file, with the scene's key before the file's own place.
template <class Read>
auto told_of(const std::string& where, Read read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", error.where, error.what_is_wrong), where, error.remedy);
  }
}

struct MeshMaker {
  const Place& place;
  const std::string& model;
  int surface_in = 0;
  std::vector<std::string>* notes = nullptr;
  CellWords* words = nullptr;

  Mesh operator()(const BarMeshSpec& s) const {
    return generate(BarMesh{0.0, s.length, s.elements, s.grading}, where("mesh.bar"));
  }
  Mesh operator()(const RectangleSpec& s) const {
    return generate(RectangleMesh{{},
                                  origin_of(s.centred),
                                  array_of<2>(s.lengths),
                                  counts_of<2>(s.elements),
                                  array_of<2>(s.grading),
                                  s.element},
                    where("mesh.rectangle"));
  }
  Mesh operator()(const DiskSpec& s) const {
    return generate(DiskMesh{{}, s.radius, s.core, s.layers, s.element}, where("mesh.disk"));
  }
  Mesh operator()(const BoxSpec& s) const {
    return generate(BoxMesh{{},
                            origin_of(s.centred),
                            array_of<3>(s.lengths),
                            counts_of<3>(s.elements),
                            array_of<3>(s.grading),
                            s.element},
                    where("mesh.box"));
  }
  Mesh operator()(const CylinderSpec& s) const {
    return generate(CylinderMesh{{},
                                 origin_of(s.centred),
                                 s.radius,
                                 s.length,
                                 s.core,
                                 s.layers,
                                 s.elements,
                                 s.grading,
                                 s.element},
                    where("mesh.cylinder"));
  }
  Mesh operator()(const SphereSpec& s) const {
    return generate(SphereMesh{{}, s.radius, s.core, s.layers, s.element}, where("mesh.sphere"));
  }
  Mesh operator()(const GmshSpec& s) const {
    return told_of(where("mesh.gmsh.file"),
                   [&, this] { return read_gmsh(s.file, s.scale, surface_in, notes); });
  }
  Mesh operator()(const AbaqusSpec& s) const {
    return told_of(where("mesh.abaqus.file"), [&, this] {
      return read_abaqus(s.file, s.scale, s.part, surface_in, notes, words);
    });
  }
  Mesh operator()(const ExodusSpec& s) const {
    return told_of(where("mesh.exodus.file"), [&s] { return read_exodus(s.file, s.scale); });
  }

  std::string where(const std::string& key) const { return place.where(model + "." + key); }
};

/// Of the distance between the farthest corners of a mesh: a node this near is meant.
constexpr double same_place = 1.0e-6;

std::string words(const double* at, int dim) {
  return fmt::format("({:.10g})", fmt::join(at, at + dim, ", "));
}

/// Node nearest to a place and its distance [m].
std::pair<std::int32_t, double> nearest_node(const Mesh& mesh, const std::vector<double>& at) {
  std::pair<std::int32_t, double> best = {0, std::numeric_limits<double>::infinity()};
  for (std::int32_t node = 0; node < mesh.node_count(); ++node) {
    double distance = 0.0;
    for (int i = 0; i < mesh.dim; ++i)
      distance = std::hypot(distance, mesh.points[node * mesh.dim + i] - at[i]);
    if (distance < best.second) best = {node, distance};
  }
  return best;
}

double size_of(const Mesh& mesh) {
  double size = 0.0;
  for (int i = 0; i < mesh.dim; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = index(i); k < mesh.points.size(); k += index(mesh.dim)) {
      low = std::min(low, mesh.points[k]);
      high = std::max(high, mesh.points[k]);
    }
    size = std::hypot(size, high - low);
  }
  return size;
}

void map_nodes(const SolidShapeSpec& spec, const Place& place, const std::string& model,
               Mesh& mesh) {
  const std::size_t dim = index(mesh.dim);
  std::vector<std::function<double(const std::array<double, 3>&, double)>> formulas;
  for (std::size_t i = 0; i < spec.map.size(); ++i)
    formulas.push_back(expression(spec.map[i], place.where(fmt::format("{}.map[{}]", model, i))));
  for (std::size_t k = 0; !formulas.empty() && k < mesh.points.size(); k += dim) {
    std::array<double, 3> at{};
    std::copy_n(mesh.points.begin() + static_cast<std::ptrdiff_t>(k), dim, at.begin());
    for (std::size_t i = 0; i < dim; ++i) {
      mesh.points[k + i] = formulas[i](at, 0.0);
      if (std::isfinite(mesh.points[k + i])) continue;
      throw InputError(fmt::format("has no value at the node {}", words(at.data(), mesh.dim)),
                       place.where(fmt::format("{}.map[{}]", model, i)),
                       "Give an expression with a value at every node of the mesh.");
    }
  }
}

}  // namespace

void name_points(const BodySpec& spec, const Place& place, Mesh& mesh) {
  for (const auto& [name, point] : spec.points) {
    const std::string key = place.where("points." + name);
    if (mesh.sides.contains(name) || mesh.node_sets.contains(name)) {
      throw InputError("is the name of a side or node set of the mesh", key,
                       "Give the point another name.");
    }
    if (point.at.size() != index(mesh.dim)) {
      throw InputError("has " + counted(point.at.size(), "number"),
                       place.where("points." + name + ".at"),
                       fmt::format("Give {} numbers, one per dimension.", mesh.dim));
    }
    const auto [node, distance] = nearest_node(mesh, point.at);
    if (distance > same_place * size_of(mesh)) {
      throw InputError(
          fmt::format("no node is at {}", words(point.at.data(), mesh.dim)),
          place.where("points." + name + ".at"),
          fmt::format("The nearest is node {} at {}: give that place, or another mesh.", node + 1,
                      words(mesh.points.data() + index(node * mesh.dim), mesh.dim)));
    }
    mesh.node_sets[name] = {node};
  }
}

std::uint64_t digest_of(const MeshFileSpec& mesh) { return digest_of_file(mesh.file); }
std::uint64_t digest_of(const AbaqusSpec& mesh) { return digest_of_abaqus(mesh.file); }

std::string on_file(const SolidShapeSpec& spec, const std::vector<std::string>& notes) {
  return std::visit(
      [&notes](const auto& mesh) -> std::string {
        if constexpr (!requires { mesh.file; }) {
          return "";
        } else {
          return fmt::format(" on {} (digest {:016x}{}{})",
                             mesh.file.substr(mesh.file.rfind('/') + 1), digest_of(mesh),
                             notes.empty() ? "" : "; ", fmt::join(notes, "; "));
        }
      },
      spec.mesh);
}

void require_same_file(const SolidShapeSpec& spec, const Place& place, const std::string& model) {
  if (spec.digest == 0) return;
  const auto check = [&](const auto& mesh) {
    if constexpr (requires { mesh.file; }) {
      const std::string where = place.where(fmt::format("{}.mesh.{}.file", model, mesh.name));
      const std::uint64_t own = told_of(where, [&mesh] { return digest_of(mesh); });
      if (own == spec.digest) return;
      throw InputError(
          fmt::format("{}: is another file than the one beside the scene: their digests are "
                      "{:016x} and {:016x}",
                      mesh.file, own, spec.digest),
          where, "Give the solver the files that lie beside the scene.");
    }
  };
  std::visit(check, spec.mesh);
}

Mesh make_mesh(const SolidShapeSpec& spec, const std::vector<double>& position, const Place& place,
               const std::string& model, std::vector<std::string>* notes) {
  require_same_file(spec, place, model);
  CellWords words;
  Mesh mesh = std::visit(
      MeshMaker{place, model, spec.surface_alone ? spec.dimension : 0, notes, &words}, spec.mesh);
  map_nodes(spec, place, model, mesh);
  check_mesh(mesh, place.where(model + ".mesh"), words);
  if (mesh.dim != spec.dimension) {
    throw InputError(fmt::format("is {}, but the mesh has {} dimensions", spec.dimension, mesh.dim),
                     place.where(model + ".dimension"), "Give the dimension of the mesh.");
  }
  if (position.size() == index(mesh.dim)) {
    for (std::size_t k = 0; k < mesh.points.size(); ++k)
      mesh.points[k] += position[k % index(mesh.dim)];
  }
  for (std::size_t k = 0; k < mesh.points.size() && spec.plane == Plane::axisymmetric; k += 2) {
    if (mesh.points[k] < 0.0) {
      throw InputError("axisymmetric, but a node has a negative radius x",
                       place.where(model + ".plane"), "Put the body at x >= 0.");
    }
  }
  return mesh;
}

void check_formulation(const FiniteElementsSpec& spec, const Mesh& mesh, const Place& place,
                       const std::string& model) {
  const std::string key = place.where(model + ".formulation");
  bool simplices = true;
  for (const CellBlock& block : mesh.blocks) {
    const Shape shape = block.element->shape;
    simplices = simplices && shape != Shape::quadrilateral && shape != Shape::hexahedron;
    if (spec.formulation != Formulation::one_point || block.element->order == 1) continue;
    throw InputError(fmt::format("one_point does not fit {}", block.element->name), key,
                     "Use quad4 or hex8 with it, or formulation: full.");
  }
  if (!simplices || mesh.dim == 1 || spec.formulation == Formulation::full) return;
  const Element& element = *mesh.blocks.front().element;
  const bool mean = spec.formulation == Formulation::mean_dilatation;
  const char* linear = mesh.dim == 2 ? "Use tri6" : "Use tet10";
  throw InputError(
      fmt::format("{} makes no difference to {}", mean ? "mean_dilatation" : "one_point",
                  element.name),
      key,
      fmt::format("{} with formulation: full, or {} with mean_dilatation where the material is "
                  "nearly incompressible.",
                  element.order == 1 ? linear : "Use it",
                  mesh.dim == 2 ? "quad4 or quad8" : "hex8 or hex20"));
}

}  // namespace abut
