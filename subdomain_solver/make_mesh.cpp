#include "subdomain_solver/make_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "subdomain_solver/fe/exodus_file.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"

namespace abut {

namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

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
                 [](double x) { return static_cast<int>(std::lround(x)); });
  return out;
}

Origin origin_of(bool centred) { return centred ? Origin::centre : Origin::corner; }

struct MeshMaker {
  const Place& place;
  const std::string& model;

  Mesh operator()(const BarMeshSpec&) const { return {}; }  // a bar is no solid
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
    return told_of("gmsh", [&s] { return read_gmsh(s.file, s.scale); });
  }
  Mesh operator()(const ExodusSpec& s) const {
    return told_of("exodus", [&s] { return read_exodus(s.file, s.scale); });
  }

  std::string where(const std::string& key) const { return place.where(model + "." + key); }

  /// An error of the mesh file, with the scene's key before the file's own place.
  template <class Read>
  Mesh told_of(const char* kind, Read read) const {
    try {
      return read();
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", error.where, error.what_is_wrong),
                       where(fmt::format("mesh.{}.file", kind)), error.remedy);
    }
  }
};

}  // namespace

Mesh make_mesh(const SolidShapeSpec& spec, const std::vector<double>& position, const Place& place,
               const std::string& model) {
  Mesh mesh = std::visit(MeshMaker{place, model}, spec.mesh);
  check_mesh(mesh, place.where(model + ".mesh"));
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

}  // namespace abut
