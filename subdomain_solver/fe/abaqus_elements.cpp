// Nodes and faces of elements as Abaqus' manual ("Three-dimensional solid element library") and
// CalculiX' (section 6.2) have them.

#include "subdomain_solver/fe/abaqus_elements.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <span>
#include <string_view>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

/// A shape: the pairs of corners between which nodes follow the corners, and the faces.
struct Ordering {
  int dim = 0, corners = 0;
  std::vector<Edge> edges;
  std::vector<std::vector<int>> faces;
};

const Ordering line_ordering = {1, 2, {{0, 1}}, {}};
const Ordering triangle = {2, 3, {{0, 1}, {1, 2}, {2, 0}}, {{0, 1}, {1, 2}, {2, 0}}};
const Ordering quadrilateral = {
    2, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
const Ordering tetrahedron = {3,
                              4,
                              {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                              {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
const Ordering pyramid = {3,
                          5,
                          {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
                          {{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}}};
const Ordering prism = {3,
                        6,
                        {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
                        {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}};
const Ordering hexahedron = {
    3,
    8,
    {{0, 1},
     {1, 2},
     {2, 3},
     {3, 0},
     {4, 5},
     {5, 6},
     {6, 7},
     {7, 4},
     {0, 4},
     {1, 5},
     {2, 6},
     {3, 7}},
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};

/// Index of the node between two corners.
int between(const Ordering& own, int a, int b) {
  for (std::size_t e = 0; e < own.edges.size(); ++e)
    if (own.edges[e] == Edge{a, b} || own.edges[e] == Edge{b, a})
      return own.corners + static_cast<int>(e);
  ABUT_ASSERT(false);
  return 0;
}

AbaqusElement abaqus_made(const Ordering& own, bool quadratic, const Element* type,
                          const DividedShape* divided) {
  AbaqusElement out;
  out.dim = own.dim;
  out.nodes = own.corners + (quadratic ? static_cast<int>(own.edges.size()) : 0);
  out.quadratic = quadratic;
  out.type = type;
  out.divided = divided;
  for (int corner = 0; corner < own.corners; ++corner) out.order.push_back(corner);
  if (quadratic && type != nullptr)
    for (const std::vector<int>& pair : type->between)
      out.order.push_back(between(own, pair[0], pair[1]));
  if (quadratic && divided != nullptr)
    for (const Edge& pair : divided->edges) out.order.push_back(between(own, pair[0], pair[1]));
  for (const std::vector<int>& corners : own.faces) {
    std::vector<int> face = corners;
    const std::size_t edges = own.dim == 2 ? 1 : corners.size();
    for (std::size_t k = 0; quadratic && k < edges; ++k)
      face.push_back(between(own, corners[k], corners[(k + 1) % corners.size()]));
    out.faces.push_back(std::move(face));
  }
  ABUT_ASSERT(out.order.size() == index(out.nodes));
  return out;
}

const Element* element_of_shape(Shape shape, int nodes) {
  for (const Element& element : all_elements())
    if (element.shape == shape && element.nodes == nodes) return &element;
  return nullptr;
}

struct Row {
  std::string_view family;  // the name without its number
  int nodes;
  const Ordering* ordering;
  Shape shape = Shape::point;  // of ours
  const DividedShape* divided = nullptr;
};

std::vector<Row> rows() {
  std::vector<Row> all = {{"C3D", 4, &tetrahedron, Shape::tetrahedron},
                          {"C3D", 10, &tetrahedron, Shape::tetrahedron},
                          {"C3D", 8, &hexahedron, Shape::hexahedron},
                          {"C3D", 20, &hexahedron, Shape::hexahedron},
                          {"C3D", 6, &prism, Shape::point, &prism_shape()},
                          {"C3D", 15, &prism, Shape::point, &prism_shape()},
                          {"C3D", 5, &pyramid, Shape::point, &pyramid_shape()},
                          {"R3D", 3, &triangle, Shape::triangle},
                          {"R3D", 4, &quadrilateral, Shape::quadrilateral}};
  for (const char* plane : {"CPS", "CPE", "CAX"}) {
    for (const int nodes : {3, 6}) all.push_back({plane, nodes, &triangle, Shape::triangle});
    for (const int nodes : {4, 8})
      all.push_back({plane, nodes, &quadrilateral, Shape::quadrilateral});
  }
  for (const char* lines : {"T2D", "T3D"})
    for (const int nodes : {2, 3}) all.push_back({lines, nodes, &line_ordering, Shape::line});
  return all;
}

std::map<std::string, AbaqusElement> make_table() {
  std::map<std::string, AbaqusElement> table;
  for (const Row& row : rows()) {
    const Element* type = row.divided == nullptr ? element_of_shape(row.shape, row.nodes) : nullptr;
    const bool quadratic = row.nodes > row.ordering->corners;
    table.emplace(std::string(row.family) + std::to_string(row.nodes),
                  abaqus_made(*row.ordering, quadratic, type, row.divided));
  }
  return table;
}

}  // namespace

const AbaqusElement* abaqus_element(const std::string& name) {
  static const std::map<std::string, AbaqusElement> table = make_table();
  constexpr std::array<std::string_view, 10> endings = {"",  "R",  "H",  "I",  "M",
                                                        "S", "RH", "IH", "MH", "HS"};
  std::size_t end = name.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) == 0) --end;
  const std::string_view ending = std::string_view(name).substr(end);
  if (std::ranges::find(endings, ending) == endings.end()) return nullptr;
  const auto found = table.find(name.substr(0, end));
  return found == table.end() ? nullptr : &found->second;
}

const AbaqusElement* abaqus_shape(int dim, int corners, bool quadratic) {
  static const AbaqusElement quadratic_pyramid =
      abaqus_made(pyramid, true, nullptr, &pyramid_shape());
  if (dim == 2 && corners == 3) return abaqus_element(quadratic ? "CPS6" : "CPS3");
  if (dim == 2 && corners == 4) return abaqus_element(quadratic ? "CPS8" : "CPS4");
  if (dim == 3 && corners == 4) return abaqus_element(quadratic ? "C3D10" : "C3D4");
  if (dim == 3 && corners == 5) return quadratic ? &quadratic_pyramid : abaqus_element("C3D5");
  if (dim == 3 && corners == 6) return abaqus_element(quadratic ? "C3D15" : "C3D6");
  if (dim == 3 && corners == 8) return abaqus_element(quadratic ? "C3D20" : "C3D8");
  return nullptr;
}

std::string abaqus_element_remedy(const std::string& name) {
  if (name.starts_with("S") || name.starts_with("M3D"))
    return "Shells and membranes are not supported: mesh the part as a solid, and name its sides "
           "by *SURFACE.";
  if (name.starts_with("B") || name.starts_with("PIPE"))
    return "Beams are not supported: mesh the part as a solid, or take these elements out.";
  return "There are C3D4, C3D10, C3D8, C3D20, C3D6, C3D15, C3D5, and CPS, CPE, CAX of 3, 4, 6 or 8 "
         "nodes, with R, H, I, M or S behind them: write the part in these, or take these elements "
         "out.";
}

}  // namespace abut
