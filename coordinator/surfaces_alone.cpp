#include "coordinator/surfaces_alone.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "surface/solid_angle.hpp"

namespace abut {

namespace {

using Facets = std::vector<std::size_t>;

/// [rad], [sr] What closed surfaces are seen by from outside, up to rounding of their facets' sum.
constexpr double nothing = 1.0e-9;
/// Points of all partners that are asked of a part, but a few of each: which side they are on does
/// not take more, and large surfaces of large partners would take minutes.
constexpr int points_asked = 200, least_asked = 4;
/// Of a facet.
constexpr double within = 0.05;

/// Facets of a port by what hangs together: facets that share a node do.
std::vector<Facets> parts_of(const PosedSurface& surface) {
  std::vector<std::int32_t> root(index(surface.node_count()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](std::int32_t node) {
    while (root[index(node)] != node)
      node = std::exchange(root[index(node)], root[index(root[index(node)])]);
    return node;
  };
  for (int f = 0; f < surface.facet_count(); ++f)
    for (const std::int32_t node : surface.nodes(f))
      root[index(find(node))] = find(surface.nodes(f).front());
  std::map<std::int32_t, Facets> parts;
  for (int f = 0; f < surface.facet_count(); ++f)
    parts[find(surface.nodes(f).front())].push_back(index(f));
  std::vector<Facets> out;
  for (auto& [node, facets] : parts) out.push_back(std::move(facets));
  return out;
}

/// The part as a surface of the same points.
struct Part {
  std::vector<std::int32_t> facets, offsets{0};

  Part(const PortGeometry& port, const Facets& of) {
    for (const std::size_t f : of) {
      facets.insert(facets.end(), port.facets.begin() + port.offsets[f],
                    port.facets.begin() + port.offsets[f + 1]);
      offsets.push_back(static_cast<std::int32_t>(facets.size()));
    }
  }
};

/// [rad], [sr] Mean of what a partner sees of a part from a little within its facets, as what lies
/// on a surface sees either side of it: from so many at most, evenly chosen.
double seen_by(const PortGeometry& partner, const PosedSurface& part, int most) {
  const PosedSurface other = posed(partner);
  const int each = 1 + (other.facet_count() - 1) / most;
  double sum = 0.0;
  int asked = 0;
  for (int f = 0; f < other.facet_count(); f += each, ++asked) {
    const Corners facet = corners(other, f);
    const double size = (facet.x[1] - facet.x[0]).norm();
    sum += solid_angle(part, centre(facet) - within * size * mean_normal(facet));
  }
  return asked > 0 ? sum / asked : 0.0;
}

void turn(PortGeometry& port, const Facets& part) {
  const std::size_t dim = index(port.dim);
  std::vector<char> turned(index(port.count()), 0);
  for (const std::size_t f : part) {
    const auto first = port.facets.begin() + port.offsets[f];
    const auto last = port.facets.begin() + port.offsets[f + 1];
    std::reverse(first, last);
    std::for_each(first, last, [&](std::int32_t node) { turned[index(node)] = 1; });
  }
  for (std::size_t k = 0; k < port.normals.size(); ++k)
    if (turned[k / dim] != 0) port.normals[k] = -port.normals[k];
}

/// Ports that may touch a port: those of interfaces with contact, or of all other bodies.
std::vector<const PortGeometry*> partners_of(const Scene& scene, const Bodies& bodies, int body,
                                             const std::string& port) {
  std::vector<const PortGeometry*> partners;
  const auto add = [&](int other, const std::string& name) {
    for (const Port& its : bodies.describe(other).ports)
      if (its.geometry.dim == bodies.describe(body).dim && (name.empty() || its.name == name))
        partners.push_back(&its.geometry);
  };
  for (int other = 0; other < bodies.count(); ++other) {
    if (other == body) continue;
    if (scene.everything() != nullptr && std::isfinite(bodies.describe(other).mass)) add(other, "");
    const std::string own = bodies.describe(body).name + "." + port;
    const std::string start = bodies.describe(other).name + ".";
    for (const auto& [name, spec] : scene.interfaces)
      for (const std::size_t s : {0u, 1u})
        if (spec.contact && spec.sides[s] == own && spec.sides[1 - s].starts_with(start))
          add(other, spec.sides[1 - s].substr(start.size()));
  }
  return partners;
}

}  // namespace

bool is_surface_alone(const Description& body, const Grid& grid) {
  constexpr std::int32_t line = 3, triangle = 5, quadrilateral = 9;  // of VTK
  return grid.cells() > 0 && std::ranges::all_of(grid.types, [&body](std::int32_t type) {
           return body.dim == 2 ? type == line
                                : body.dim == 3 && (type == triangle || type == quadrilateral);
         });
}

void turn_surfaces_alone(const Scene& scene, Bodies& bodies) {
  for (int b = 0; b < bodies.count(); ++b) {
    const Description& body = bodies.describe(b);
    if (std::isfinite(body.mass) || body.dim == 1 || body.fields.empty()) continue;
    if (!is_surface_alone(body, bodies[b].grid())) continue;
    Description told = body;
    for (Port& port : told.ports) {
      const std::vector<const PortGeometry*> partners = partners_of(scene, bodies, b, port.name);
      const int count = std::max(1, static_cast<int>(partners.size()));
      const int most = std::max(least_asked, points_asked / count);
      for (const Facets& facets : parts_of(posed(port.geometry))) {
        const Part part(port.geometry, facets);
        const PosedSurface surface{port.geometry.dim, port.geometry.points, part.facets,
                                   part.offsets};
        double seen = 0.0;
        for (const PortGeometry* partner : partners) seen += seen_by(*partner, surface, most);
        if (seen < -nothing) turn(port.geometry, facets);
      }
    }
    bodies.tell_of(b, std::move(told));
  }
}

}  // namespace abut
