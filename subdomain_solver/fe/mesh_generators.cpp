#include "subdomain_solver/fe/mesh_generators.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/element_limit.hpp"
#include "subdomain_solver/fe/lattice_mesh.hpp"

namespace abut {
namespace {

using Point = std::array<double, 3>;

// Refusals -------------------------------------------------------------------------------------

const Element& choose(const std::string& name, int dim, const std::string& where) {
  const std::vector<std::string_view> fitting = generated_elements(dim);
  if (std::find(fitting.begin(), fitting.end(), name) != fitting.end()) return element_named(name);
  throw InputError("must be an element that fits, but is '" + name + "'", where + ".element",
                   fmt::format("Choose one of {}.", fmt::join(fitting, ", ")));
}

void require_positive(double value, const std::string& where) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError(fmt::format("must be positive and finite, but is {}", value), where,
                   "Give a size greater than zero.");
}

void require_grading(double value, const std::string& where) {
  if (value >= 1e-6 && value <= 1e6) return;
  throw InputError(fmt::format("must be from 1e-6 to 1e6, but is {}", value), where,
                   "Give the length of the last element over that of the first.");
}

void require_finite(std::span<const double> values, const std::string& where) {
  for (double value : values) {
    if (!std::isfinite(value))
      throw InputError(fmt::format("must be finite, but is {}", value), where, "Give a number.");
  }
}

void require_count(int value, const std::string& where) {
  if (value >= 1 && value <= most_lattice_cells) return;
  throw InputError(fmt::format("must be from 1 to {}, but is {}", most_lattice_cells, value), where,
                   "Change the number of elements.");
}

// Coordinates ----------------------------------------------------------------------------------

/// Coordinates of a line of graded elements, with those halfway in between [m] (2 elements + 1).
std::vector<double> graded_line(double begin, double length, int elements, double grading) {
  const double growth = elements > 1 ? std::pow(grading, 1.0 / (elements - 1)) : 1.0;
  std::vector<double> sizes(index(elements), 1.0);
  double sum = 1.0;
  for (std::size_t e = 1; e < sizes.size(); ++e) {
    sizes[e] = grading == 1.0 ? 1.0 : sizes[e - 1] * growth;
    sum += sizes[e];
  }
  std::vector<double> x(2 * sizes.size() + 1, begin);
  double passed = 0.0;
  for (std::size_t e = 0; e < sizes.size(); ++e) {
    passed += sizes[e];
    x[2 * e + 2] = e + 1 == sizes.size() ? begin + length : begin + length * (passed / sum);
    x[2 * e + 1] = 0.5 * (x[2 * e] + x[2 * e + 2]);
  }
  return x;
}

double lower_end(double origin, Origin at, double length) {
  return at == Origin::corner ? origin : origin - 0.5 * length;
}

/// Calls `visit` with the lowest corner of all cells of a box of cells.
template <typename Visit>
void for_cells(std::array<int, 3> cells, Visit visit) {
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) visit(LatticePoint{{2 * i, 2 * j, 2 * k, 0}});
}

// Boxes ----------------------------------------------------------------------------------------

constexpr std::array<std::array<const char*, 2>, 3> side_names = {
    {{"left", "right"}, {"bottom", "top"}, {"back", "front"}}};

template <std::size_t Dim>
struct Lengths {
  std::array<double, Dim> origin;
  Origin origin_at;
  std::array<double, Dim> lengths;
  std::array<int, Dim> elements;
  std::array<double, Dim> grading;
};

template <std::size_t Dim>
Mesh box(const Lengths<Dim>& data, const Element& element, const std::string& where) {
  require_finite(data.origin, where + ".origin");
  std::array<std::vector<double>, 3> x;
  std::array<int, 3> cells = {1, 1, 1}, last = {0, 0, 0};
  double total = 1.0;
  for (std::size_t d = 0; d < Dim; ++d) {
    require_positive(data.lengths[d], where + (Dim == 1 ? ".length" : ".lengths"));
    require_grading(data.grading[d], where + ".grading");
    require_count(data.elements[d], where + ".elements");
    total *= data.elements[d];
    cells[d] = data.elements[d];
    last[d] = 2 * cells[d];
  }
  require_room(total, bytes_of_cell, where + ".elements");
  for (std::size_t d = 0; d < Dim; ++d) {
    x[d] = graded_line(lower_end(data.origin[d], data.origin_at, data.lengths[d]), data.lengths[d],
                       cells[d], data.grading[d]);
  }
  LatticeMesh mesh(element, [&x](const LatticePoint& place) {
    Point point{};
    for (std::size_t d = 0; d < Dim; ++d) point[d] = x[d][place.at[d]];
    return point;
  });
  for_cells(cells, [&mesh](const LatticePoint& lowest) {
    mesh.add_cell(cell_corners(static_cast<int>(Dim), lowest));
  });
  for (std::size_t d = 0; d < Dim; ++d) {
    for (int end : {0, 1}) {
      mesh.name_side(side_names[d][end], [d, end, &last](const LatticePoint& place) {
        return place.at[d] == end * last[d];
      });
    }
  }
  for (unsigned corner = 0; Dim > 1 && corner < (1u << Dim); ++corner) {
    LatticePoint place;
    std::string name;
    for (std::size_t d = 0; d < Dim; ++d) {
      const unsigned end = (corner >> d) & 1u;
      place.at[d] = end == 1 ? last[d] : 0;
      if (d > 0) name += '_';
      name += side_names[d][end];
    }
    mesh.name_nodes(name, [&place](const LatticePoint& other) { return other == place; });
  }
  return mesh.finish();
}

// Round parts ----------------------------------------------------------------------------------

// Half the core's width over the radius, and how far its straight sides bulge towards a circle:
// with these the angles where three blocks meet are near 120 degrees in the plane.
constexpr double core_share = 0.5, core_bulge = 0.5;

/// The unit square or cube onto the unit disk or ball, smooth: x sqrt(1 - y^2/2) and, in space,
/// x sqrt(1 - y^2/2 - z^2/2 + y^2 z^2/3) (Nowell 2005).
template <std::size_t Dim>
Point cube_to_ball(const Point& q) {
  Point x{};
  for (std::size_t d = 0; d < Dim; ++d) {
    const double a = q[(d + 1) % Dim] * q[(d + 1) % Dim];
    const double b = Dim == 3 ? q[(d + 2) % Dim] * q[(d + 2) % Dim] : 0.0;
    x[d] = q[d] * std::sqrt(1.0 - 0.5 * a - 0.5 * b + a * b / 3.0);
  }
  return x;
}

/// Unit vector to a place on the surface of the cube, with equal angles between equal steps.
template <std::size_t Dim>
Point direction(const Point& q) {
  Point x{};
  double square = 0.0;
  for (std::size_t d = 0; d < Dim; ++d) {
    x[d] = std::tan(0.25 * std::numbers::pi * q[d]);
    square += x[d] * x[d];
  }
  for (double& value : x) value /= std::sqrt(square);
  return x;
}

/// Place of the O-grid in the unit disk or ball.
template <std::size_t Dim>
Point round_place(const LatticePoint& place, int core, int layers) {
  Point q{};
  for (std::size_t d = 0; d < Dim; ++d) q[d] = static_cast<double>(place.at[d]) / core - 1.0;
  const Point ball = cube_to_ball<Dim>(q);
  const double outwards = static_cast<double>(place.at[3]) / (2 * layers);
  const Point end = outwards > 0.0 ? direction<Dim>(q) : Point{};
  Point x{};
  for (std::size_t d = 0; d < Dim; ++d) {
    const double inner = core_share * ((1.0 - core_bulge) * q[d] + core_bulge * ball[d]);
    x[d] = (1.0 - outwards) * inner + outwards * end[d];
  }
  return x;
}

/// Adds the cells of an O-grid in the first `Round` directions, `along` cells in the others.
template <std::size_t Round>
void add_round_cells(LatticeMesh& mesh, int dim, int core, int layers, int along) {
  std::array<int, 3> cells = {core, core, core};
  if (Round == 2) cells[2] = along;
  for_cells(cells,
            [&mesh, dim](const LatticePoint& lowest) { mesh.add_cell(cell_corners(dim, lowest)); });
  // A layer's cell is the cell that the lattice would have outside of the core, with the step
  // outwards taken in the layers instead.
  for (int layer = 0; layer < layers; ++layer) {
    for (std::size_t d = 0; d < Round; ++d) {
      for (int end : {0, 1}) {
        std::array<int, 3> surface = cells;
        surface[d] = 1;
        if (dim == 2) surface[2] = 1;
        for_cells(surface, [=, &mesh](LatticePoint lowest) {
          lowest.at[d] = end == 1 ? 2 * core : -2;
          std::vector<LatticePoint> corners = cell_corners(dim, lowest);
          for (LatticePoint& corner : corners) {
            const bool outer = corner.at[d] < 0 || corner.at[d] > 2 * core;
            corner.at[d] = end == 1 ? 2 * core : 0;
            corner.at[3] = 2 * (layer + (outer ? 1 : 0));
          }
          mesh.add_cell(corners);
        });
      }
    }
  }
}

void require_round(double radius, int core, int layers, double along, double dims,
                   const std::string& where) {
  require_positive(radius, where + ".radius");
  require_count(core, where + ".core");
  require_count(layers, where + ".layers");
  const double shell = 2.0 * dims * std::pow(core, dims - 1.0) * layers;
  require_room(along * (std::pow(core, dims) + shell), bytes_of_cell, where);
}

}  // namespace

Mesh generate(const BarMesh& data, const std::string& where) {
  const Lengths<1> lengths = {
      {data.origin}, Origin::corner, {data.length}, {data.elements}, {data.grading}};
  return box(lengths, linear_element(Shape::line), where);
}

Mesh generate(const RectangleMesh& data, const std::string& where) {
  const Element& element = choose(data.element, 2, where);
  const Lengths<2> lengths = {data.origin, data.origin_at, data.lengths, data.elements,
                              data.grading};
  return box(lengths, element, where);
}

Mesh generate(const BoxMesh& data, const std::string& where) {
  const Element& element = choose(data.element, 3, where);
  const Lengths<3> lengths = {data.origin, data.origin_at, data.lengths, data.elements,
                              data.grading};
  return box(lengths, element, where);
}

Mesh generate(const DiskMesh& data, const std::string& where) {
  const Element& element = choose(data.element, 2, where);
  require_finite(data.centre, where + ".centre");
  require_round(data.radius, data.core, data.layers, 1.0, 2.0, where);
  LatticeMesh mesh(element, [&data](const LatticePoint& place) {
    const Point unit = round_place<2>(place, data.core, data.layers);
    return Point{data.centre[0] + data.radius * unit[0], data.centre[1] + data.radius * unit[1]};
  });
  add_round_cells<2>(mesh, 2, data.core, data.layers, 1);
  mesh.name_side("mantle", [&data](const LatticePoint& at) { return at.at[3] == 2 * data.layers; });
  const LatticePoint centre = {{data.core, data.core, 0, 0}};
  mesh.name_nodes("centre", [&centre](const LatticePoint& at) { return at == centre; });
  return mesh.finish();
}

Mesh generate(const CylinderMesh& data, const std::string& where) {
  const Element& element = choose(data.element, 3, where);
  require_finite(data.origin, where + ".origin");
  require_positive(data.length, where + ".length");
  require_grading(data.grading, where + ".grading");
  require_count(data.elements, where + ".elements");
  require_round(data.radius, data.core, data.layers, data.elements, 2.0, where);
  const std::vector<double> z = graded_line(lower_end(data.origin[2], data.origin_at, data.length),
                                            data.length, data.elements, data.grading);
  LatticeMesh mesh(element, [&data, &z](const LatticePoint& place) {
    const Point unit = round_place<2>(place, data.core, data.layers);
    return Point{data.origin[0] + data.radius * unit[0], data.origin[1] + data.radius * unit[1],
                 z[place.at[2]]};
  });
  add_round_cells<2>(mesh, 3, data.core, data.layers, data.elements);
  mesh.name_side("mantle", [&data](const LatticePoint& at) { return at.at[3] == 2 * data.layers; });
  mesh.name_side("bottom", [](const LatticePoint& at) { return at.at[2] == 0; });
  mesh.name_side("top", [&data](const LatticePoint& at) { return at.at[2] == 2 * data.elements; });
  mesh.name_nodes("axis", [&data](const LatticePoint& at) {
    return at.at[0] == data.core && at.at[1] == data.core && at.at[3] == 0;
  });
  return mesh.finish();
}

Mesh generate(const SphereMesh& data, const std::string& where) {
  const Element& element = choose(data.element, 3, where);
  require_finite(data.centre, where + ".centre");
  require_round(data.radius, data.core, data.layers, 1.0, 3.0, where);
  LatticeMesh mesh(element, [&data](const LatticePoint& place) {
    Point x = round_place<3>(place, data.core, data.layers);
    for (std::size_t d = 0; d < x.size(); ++d) x[d] = data.centre[d] + data.radius * x[d];
    return x;
  });
  add_round_cells<3>(mesh, 3, data.core, data.layers, data.core);
  mesh.name_side("surface",
                 [&data](const LatticePoint& at) { return at.at[3] == 2 * data.layers; });
  const LatticePoint centre = {{data.core, data.core, data.core, 0}};
  mesh.name_nodes("centre", [&centre](const LatticePoint& at) { return at == centre; });
  return mesh.finish();
}

}  // namespace abut
