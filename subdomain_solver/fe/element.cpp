#include "subdomain_solver/fe/element.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

bool simplex_or_line(const Element& element) {
  using enum Shape;
  return element.shape == line || element.shape == triangle || element.shape == tetrahedron;
}

}  // namespace

int Element::corner_count() const {
  switch (shape) {
    case Shape::point:
      return 1;
    case Shape::line:
      return 2;
    case Shape::triangle:
      return 3;
    case Shape::quadrilateral:
    case Shape::tetrahedron:
      return 4;
    case Shape::hexahedron:
      return 8;
  }
  return 0;
}

const Element& element_named(std::string_view name) {
  std::string names;
  for (const Element& element : all_elements()) {
    if (element.name == name) return element;
    names += (names.empty() ? "" : ", ") + std::string(element.name);
  }
  throw InputError("is not an element: " + std::string(name), "", "Choose one of " + names + ".");
}

const Element& linear_element(Shape shape) {
  for (const Element& element : all_elements())
    if (element.shape == shape && element.order == 1) return element;
  ABUT_ASSERT(false);
  return all_elements().front();
}

std::vector<std::string_view> generated_elements(int dim) {
  std::vector<std::string_view> names;
  for (const Element& element : all_elements()) {
    const bool simplex = simplex_or_line(element);
    const bool in_lattice = std::ranges::all_of(
        element.between,
        [simplex](const std::vector<int>& corners) { return !simplex || corners.size() == 2; });
    if (element.dim == dim && in_lattice) names.push_back(element.name);
  }
  return names;
}

Tabulation tabulate(const Element& element, const Quadrature& rule) {
  Tabulation table;
  table.points = rule.count();
  table.nodes = element.nodes;
  table.dim = element.dim;
  table.weight = rule.weights;
  const auto points = index(table.points);
  const auto nodes = index(table.nodes);
  const auto dim = index(table.dim);
  ABUT_ASSERT(rule.points.size() == points * dim);
  table.n.resize(points * nodes);
  table.dn.resize(points * nodes * dim);
  for (std::size_t q = 0; q < points; ++q) {
    element.evaluate(std::span(rule.points).subspan(q * dim, dim),
                     std::span(table.n).subspan(q * nodes, nodes),
                     std::span(table.dn).subspan(q * nodes * dim, nodes * dim));
  }
  return table;
}

// On squares and cubes a derivative in one direction keeps the full degree in the others.
int stiffness_degree(const Element& element) {
  return 2 * (simplex_or_line(element) ? element.order - 1 : element.order);
}

int mass_degree(const Element& element) { return 2 * element.order; }

}  // namespace abut
