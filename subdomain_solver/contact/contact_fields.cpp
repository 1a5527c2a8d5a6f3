#include "subdomain_solver/contact/contact_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/index.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

namespace {

/// Of the largest: smaller pressures are none.
constexpr double least_share = 1.0e-9;

/// Of a node's force, what it must have along the normal of a facet, over the most that it has on
/// one of the node's: facets around an edge that look elsewhere are not pressed.
constexpr double along_normal = 0.6;

struct Touch {
  std::vector<double> pose, normals, weights;      // now; [m], [m^2] of the facets that are pressed
  std::vector<std::array<double, 4>> facet_parts;  // [m^2] (facets) of them, by node
  std::vector<double> pressure;                    // [Pa] (points)
  double most = 0.0;
};

/// Weights and normals of the nodes, of facets that the force on a node may press.
void weigh(const TouchedSurface& s, const PosedSurface& now, std::span<const double> forces,
           Touch& t) {
  const int dim = now.dim;
  std::vector<Eigen::Vector3d> facet_normals;
  std::vector<double> most(s.nodes.size(), 0.0);  // [N] along one of its facets' normals
  const auto inward = [&](std::int32_t node, const Eigen::Vector3d& normal) {
    double sum = 0.0;
    for (int i = 0; i < dim; ++i) sum -= normal(i) * forces[s.first + index(node * dim + i)];
    return sum;
  };
  for (int f = 0; f < now.facet_count(); ++f) {
    facet_normals.push_back(mean_normal(corners(now, f)));
    for (const std::int32_t node : now.nodes(f))
      most[index(node)] = std::max(most[index(node)], inward(node, facet_normals.back()));
  }
  t.normals.assign(t.pose.size(), 0.0);
  t.weights.assign(s.nodes.size(), 0.0);
  for (int f = 0; f < now.facet_count(); ++f) {
    std::array<double, 4>& parts = t.facet_parts.emplace_back(facet_weights(now, f));
    const Eigen::Vector3d normal = facet_normals[index(f)], whole = area_vector(corners(now, f));
    const std::span<const std::int32_t> nodes = now.nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t node = index(nodes[i]);
      if (most[node] > 0.0 && inward(nodes[i], normal) < along_normal * most[node]) parts[i] = 0.0;
      if (parts[i] == 0.0) continue;
      t.weights[node] += parts[i];
      for (int k = 0; k < dim; ++k) t.normals[node * index(dim) + index(k)] += whole(k);
    }
  }
}

/// Of facets that show a face of second order the forces of its nodes are those of the element's
/// shapes (1 : 4 : 1 along an edge), not those of the facets: their pressure is known on the
/// average over the face, and of a node that of its faces by area.
void smooth_faces(const PortGeometry& geometry, const PosedSurface& now, Touch& t) {
  if (std::ranges::none_of(geometry.parts, [](std::int32_t parts) { return parts > 1; })) return;
  std::vector<double> of_faces(t.pressure.size(), 0.0);  // [N] weights times pressures
  int facet = 0;
  for (const std::int32_t parts : geometry.parts) {
    double force = 0.0, area = 0.0;
    const auto each = [&](const auto& visit) {
      for (int f = facet; f < facet + parts; ++f) {
        const std::span<const std::int32_t> nodes = now.nodes(f);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          visit(index(nodes[i]), t.facet_parts[index(f)][i]);
      }
    };
    each([&](std::size_t node, double weight) {
      force += weight * t.pressure[node];
      area += weight;
    });
    each([&](std::size_t node, double weight) {
      if (area > 0.0) of_faces[node] += weight * force / area;
    });
    facet += parts;
  }
  for (std::size_t a = 0; a < t.pressure.size(); ++a)
    t.pressure[a] = t.weights[a] > 0.0 ? of_faces[a] / t.weights[a] : 0.0;
}

Touch touch_of(const TouchedSurface& s, std::span<const double> forces,
               std::span<const double> places) {
  Touch t;
  const std::size_t dim = index(s.geometry->dim);
  t.pose = s.geometry->points;
  for (std::size_t v = 0; v < t.pose.size(); ++v) t.pose[v] += places[s.first + v];
  const PosedSurface now = posed(*s.geometry, t.pose);
  weigh(s, now, forces, t);
  const double thickness = dim == 2 && !s.geometry->round ? s.thickness : 1.0;
  for (std::size_t a = 0; a < s.nodes.size(); ++a) {
    const Eigen::Map<const Eigen::VectorXd> normal(t.normals.data() + a * dim, s.geometry->dim);
    const Eigen::Map<const Eigen::VectorXd> force(forces.data() + s.first + a * dim,
                                                  s.geometry->dim);
    const double size = normal.norm(), weight = t.weights[a] * thickness;
    t.pressure.push_back(weight > 0.0 && size > 0.0 ? -normal.dot(force) / size / weight : 0.0);
  }
  smooth_faces(*s.geometry, now, t);
  for (double& weight : t.weights) weight *= thickness;
  for (const double pressure : t.pressure) t.most = std::max(t.most, pressure);
  return t;
}

}  // namespace

std::vector<std::string> touch_measure_names(const std::vector<TouchedSurface>& surfaces) {
  std::vector<std::string> names;
  for (const TouchedSurface& s : surfaces)
    for (const char* what :
         {".contact.pressure_max", ".contact.area", ".contact.stick_area", ".contact.spread"})
      names.push_back(s.name + what);
  return names;
}

void touch_measures(const std::vector<TouchedSurface>& surfaces, const SurfaceContact* contact,
                    std::span<const double> forces, std::span<const double> places,
                    std::vector<double>& out) {
  std::vector<bool> held;  // (points)
  for (const TouchedSurface& s : surfaces) {
    const Touch t = touch_of(s, forces, places);
    const std::size_t dim = index(s.geometry->dim);
    double area = 0.0, stick_area = 0.0, force = 0.0, square = 0.0;
    held.assign(t.pressure.size(), false);
    if (contact != nullptr)
      contact->seen_gaps().visit(s.port, s.nodes.size(),
                                 [&held](std::size_t point, double, bool sticks) {
                                   if (sticks) held[point] = true;
                                 });
    std::vector<double> centre(dim, 0.0);
    const auto each = [&](const auto& visit) {
      for (std::size_t a = 0; a < t.pressure.size(); ++a)
        if (t.pressure[a] > least_share * t.most) visit(a, t.pressure[a] * t.weights[a]);
    };
    each([&](std::size_t a, double part) {
      area += t.weights[a];
      if (held[a]) stick_area += t.weights[a];
      force += part;
      for (std::size_t i = s.geometry->round ? 1 : 0; i < dim; ++i)
        centre[i] += part * t.pose[a * dim + i];  // that of rings is on the axis
    });
    each([&](std::size_t a, double part) {
      for (std::size_t i = 0; i < dim; ++i) {
        const double away = t.pose[a * dim + i] - centre[i] / force;
        square += part * away * away;
      }
    });
    out.insert(out.end(),
               {t.most, area, stick_area, force > 0.0 ? std::sqrt(square / force) : 0.0});
  }
}

std::vector<FieldInfo> touch_fields(bool finds) {
  std::vector<FieldInfo> fields = {{"contact_pressure", FieldPlace::nodes, 1},
                                   {"contact_status", FieldPlace::nodes, 1}};
  if (finds) fields.push_back({"contact_gap", FieldPlace::nodes, 1});
  return fields;
}

std::vector<FieldValues> touch_field_values(const std::vector<TouchedSurface>& surfaces,
                                            const SurfaceContact* contact, std::size_t nodes,
                                            std::span<const double> forces,
                                            std::span<const double> places) {
  std::vector<FieldValues> out(contact != nullptr ? 3 : 2, FieldValues(nodes, 0.0));
  for (const TouchedSurface& s : surfaces) {
    if (contact != nullptr)
      contact->seen_gaps().visit(s.port, s.nodes.size(),
                                 [&](std::size_t point, double gap, bool sticks) {
                                   double& status = out[1][s.nodes[point]];
                                   double& least = out[2][s.nodes[point]];
                                   // of all partners
                                   least = status == 0.0 ? gap : std::min(least, gap);
                                   status = std::max(status, sticks ? 3.0 : 1.0);
                                 });
    const Touch t = touch_of(s, forces, places);
    for (std::size_t a = 0; a < t.pressure.size(); ++a) {
      if (t.pressure[a] == 0.0) continue;
      out[0][s.nodes[a]] = t.pressure[a];
      if (t.pressure[a] > least_share * t.most)
        out[1][s.nodes[a]] = std::max(2.0, out[1][s.nodes[a]]);
    }
  }
  return out;
}

}  // namespace abut
