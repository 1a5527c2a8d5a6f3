#pragma once

#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// A line, square or cube of side 1 with its corner at the origin, n elements along each edge.
inline Mesh unit_mesh(const std::string& element, int n) {
  if (element_named(element).dim == 1) return generate(BarMesh{0.0, 1.0, n}, "test");
  if (element_named(element).dim == 2) {
    RectangleMesh m;
    m.lengths = {1.0, 1.0};
    m.elements = {n, n};
    m.element = element;
    return generate(m, "test");
  }
  BoxMesh m;
  m.lengths = {1.0, 1.0, 1.0};
  m.elements = {n, n, n};
  m.element = element;
  return generate(m, "test");
}

/// Moves the nodes inside a unit mesh, so that no cell is a parallelepiped. `size` in parts of the
/// unit; nodes on the boundary stay.
inline void distort(Mesh& mesh, double size) {
  std::mt19937_64 engine(7);
  const std::size_t dim = index(mesh.dim);
  for (std::size_t node = 0; node < mesh.points.size() / dim; ++node) {
    double* x = mesh.points.data() + node * dim;
    bool inside = true;
    for (std::size_t i = 0; i < dim; ++i) inside = inside && x[i] > 1.0e-9 && x[i] < 1.0 - 1.0e-9;
    for (std::size_t i = 0; i < dim; ++i) {
      const double draw = static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5;
      if (inside) x[i] += 2.0 * size * draw;
    }
  }
}

/// Puts the nodes between two corners of a cell into their middle.
inline void straighten(Mesh& mesh) {
  const int dim = mesh.dim;
  for (const CellBlock& cells : mesh.blocks) {
    const Element& e = *cells.element;
    const Eigen::Map<const Eigen::MatrixXd> xi(e.corners.data(), dim, e.nodes);
    Eigen::Map<Eigen::MatrixXd> x(mesh.points.data(), dim, mesh.node_count());
    for (int c = 0; c < cells.count(); ++c) {
      const std::int32_t* nodes = cells.nodes.data() + c * e.nodes;
      for (int m = e.corner_count(); m < e.nodes; ++m) {
        for (int a = 0; a < e.corner_count(); ++a) {
          for (int b = 0; b < a; ++b) {
            if (!xi.col(m).isApprox(0.5 * (xi.col(a) + xi.col(b)), 1.0e-12)) continue;
            x.col(nodes[m]) = 0.5 * (x.col(nodes[a]) + x.col(nodes[b]));
          }
        }
      }
    }
  }
}

/// Every element that fills a plane or space.
inline std::vector<std::string> solid_elements() {
  std::vector<std::string> names;
  for (const Element& e : all_elements()) {
    if (e.dim >= 2) names.emplace_back(e.name);
  }
  return names;
}

/// The same and the element of bars.
inline std::vector<std::string> fe_elements() {
  std::vector<std::string> names = solid_elements();
  names.emplace_back("bar2");
  return names;
}

/// An element under a formulation, in a plane where it has two dimensions.
struct ElementCase {
  std::string element;
  Formulation formulation = Formulation::full;
  Plane plane = Plane::strain;
};

inline const char* name_of(Formulation formulation) {
  constexpr const char* names[] = {"full", "mean_dilatation", "one_point"};
  return names[static_cast<int>(formulation)];
}
inline const char* name_of(Plane plane) {
  constexpr const char* names[] = {"strain", "stress", "axisymmetric"};
  return names[static_cast<int>(plane)];
}
inline void PrintTo(const ElementCase& c, std::ostream* out) {
  *out << c.element << " " << name_of(c.formulation) << " " << name_of(c.plane);
}

/// Every element with every formulation and plane that a model takes.
inline std::vector<ElementCase> element_cases() {
  std::vector<ElementCase> out;
  for (const std::string& name : fe_elements()) {
    const Element& element = element_named(name);
    for (Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::one_point}) {
      const bool mean = formulation == Formulation::mean_dilatation;
      if (formulation == Formulation::one_point && element.order > 1) continue;
      for (Plane plane : {Plane::strain, Plane::stress, Plane::axisymmetric}) {
        if (plane != Plane::strain && element.dim != 2) continue;
        if (mean && (plane == Plane::stress || element.dim == 1)) continue;
        out.push_back({name, formulation, plane});
      }
    }
  }
  return out;
}

}  // namespace abut
