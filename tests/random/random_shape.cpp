// Which parts there are, and how they are meshed.

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tests/random/lattice.hpp"

namespace abut {

namespace {

constexpr double pi = std::numbers::pi;

void centre(Shape& shape) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : shape.points) mean += x / double(shape.points.size());
  for (Eigen::Vector3d& x : shape.points) x -= mean;
}

/// A mesh of rectangles or boxes as a scene's generator makes it.
std::string generator_of(const Eigen::Vector3d& lengths, const std::array<int, 3>& counts,
                         const std::string& element) {
  const bool flat = element == "quad4" || element == "tri3";
  std::string sizes = fmt::format("{:.17g}, {:.17g}", lengths(0), lengths(1));
  std::string cells = fmt::format("{}, {}", counts[0], counts[1]);
  if (!flat) sizes += fmt::format(", {:.17g}", lengths(2));
  if (!flat) cells += fmt::format(", {}", counts[2]);
  return fmt::format("{}: {{lengths: [{}], elements: [{}], element: {}, origin: centre}}",
                     flat ? "rectangle" : "box", sizes, cells, element);
}

/// A rectangle or a box; the nodes of some are shaken.
Shape random_brick(Draw& draw, int dim, double size) {
  const std::string element = dim == 2 ? draw.of<std::string>({"quad4", "tri3"})
                                       : draw.of<std::string>({"hex8", "hex8", "tet4"});
  const int most = dim == 2 ? 6 : element == "hex8" ? 3 : 2;
  const std::array<int, 3> counts = {draw.whole(1, most), draw.whole(1, most), draw.whole(1, most)};
  Eigen::Vector3d lengths{size, size * draw.decades(0.2, 1.0), size * draw.decades(0.2, 1.0)};
  if (dim == 2) lengths(2) = 0.0;
  if (draw.chance(0.3)) std::swap(lengths(0), lengths(1));
  Shape shape = lattice(draw, element, counts, false,
                        [&](const Eigen::Vector3d& s) { return lengths.cwiseProduct(s).eval(); });
  shape.kind = dim == 2 ? "rectangle" : "brick";
  if (shape.cells.size() == 1) shape.kind = "cell";
  centre(shape);
  if (draw.chance(0.4)) {
    shape.generator = generator_of(lengths, counts, element);
  } else {
    Shape shaken = shape;
    for (Eigen::Vector3d& x : shaken.points)
      for (int i = 0; i < dim; ++i) x(i) += draw.uniform(-0.2, 0.2) * lengths(i) / counts[i];
    if (sound(shaken)) {
      orient(shaken);
      shape = shaken;
    }
  }
  return shape;
}

Shape random_arch(Draw& draw, int dim, double size) {
  const bool whole = draw.chance(0.5);
  const double inner = draw.uniform(0.4, 0.85),
               way = whole ? 2.0 * pi : draw.uniform(0.5, 1.5) * pi;
  const double start = whole ? 0.0 : 0.5 * (pi - way), depth = size * draw.uniform(0.15, 0.5);
  const std::string element =
      dim == 2 ? draw.of<std::string>({"quad4", "tri3"}) : draw.of<std::string>({"hex8", "tet4"});
  const int around = dim == 2 ? draw.whole(whole ? 6 : 3, 16) : draw.whole(whole ? 5 : 3, 9);
  const std::array<int, 3> counts = {around, draw.whole(1, 2), 1};
  // The angle falls along the first axis, so that cells are not inside out.
  Shape shape = lattice(draw, element, counts, whole, [&](const Eigen::Vector3d& s) {
    const double r = 0.5 * size * (inner + (1.0 - inner) * s(1)),
                 angle = start + way * (1.0 - s(0));
    return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), dim == 3 ? depth * s(2) : 0.0);
  });
  shape.kind = whole ? "ring" : "arch";
  return shape;
}

/// One triangle, refined: of any angles, or a tip of a few degrees that looks down.
Shape random_triangle(Draw& draw, double size) {
  Shape shape;
  shape.element = "tri3";
  const bool spike = draw.chance(0.5);
  const double half = spike ? std::tan(draw.uniform(4.0, 20.0) * pi / 180.0) : 0.0;
  if (spike)
    shape.points = {{0.0, 0.0, 0.0}, {half * size, size, 0.0}, {-half * size, size, 0.0}};
  else
    shape.points = {{0.0, 0.0, 0.0},
                    {size, 0.0, 0.0},
                    {size * draw.uniform(-0.2, 1.2), size * draw.uniform(0.25, 1.0), 0.0}};
  shape.cells = {{0, 1, 2}};
  shape.kind = spike ? "spike" : "triangle";
  for (int k = draw.whole(0, 3); k > 0; --k) refine_triangles(shape);
  return shape;
}

/// A pyramid on its tip, or one tetrahedron of any form.
Shape random_tetrahedra(Draw& draw, double size) {
  Shape shape;
  shape.dim = 3;
  shape.element = "tet4";
  if (draw.chance(0.5)) {
    const double half = size * std::tan(draw.uniform(8.0, 35.0) * pi / 180.0);
    shape.points = {{-half, size, -half},
                    {half, size, -half},
                    {half, size, half},
                    {-half, size, half},
                    {0.0, 0.0, 0.0}};
    shape.cells = {{0, 1, 2, 4}, {0, 2, 3, 4}};
    shape.kind = "pyramid";
  } else {
    shape.points = {{0.0, 0.0, 0.0},
                    {size, 0.0, 0.0},
                    {size * draw.uniform(0.0, 1.0), size * draw.uniform(0.3, 1.0), 0.0},
                    {size * draw.uniform(0.0, 1.0), size * draw.uniform(0.0, 0.6),
                     size * draw.uniform(0.3, 1.0)}};
    shape.cells = {{0, 1, 2, 3}};
    shape.kind = "tetrahedron";
  }
  orient(shape);
  for (int k = draw.whole(0, 1); k > 0; --k) refine_tetrahedra(shape);
  return shape;
}

}  // namespace

Shape random_shape(Draw& draw, int dim, double size) {
  const double which = draw.uniform(0.0, 1.0);
  Shape shape;
  if (which < 0.45) {
    shape = random_brick(draw, dim, size);
  } else if (which < 0.65) {
    shape = random_arch(draw, dim, size);
  } else if (dim == 2) {
    shape = random_triangle(draw, size);
  } else if (which < 0.75) {
    const Shape flat = random_triangle(draw, size);
    shape = prism(flat, size * draw.uniform(0.2, 0.8), 1);
    shape.kind = "wedge";
    if (shape.cells.size() > 60) shape = random_tetrahedra(draw, size);
  } else {
    shape = random_tetrahedra(draw, size);
  }
  shape.dim = dim;
  if (shape.generator.empty() && (shape.element == "tri3" || shape.element == "tet4") &&
      shape.cells.size() < 20 && draw.chance(0.15))
    raise_order(shape);
  centre(shape);
  return shape;
}

Shape random_floor(Draw& draw, int dim, double width) {
  const std::array<int, 3> counts = {draw.whole(1, dim == 2 ? 8 : 3), draw.whole(1, 2),
                                     draw.whole(1, 3)};
  const Eigen::Vector3d lengths(width, width * draw.uniform(0.1, 0.3), dim == 3 ? width : 0.0);
  const std::string element =
      dim == 2 ? draw.of<std::string>({"quad4", "tri3"}) : draw.of<std::string>({"hex8", "tet4"});
  Shape shape = lattice(draw, element, counts, false,
                        [&](const Eigen::Vector3d& s) { return lengths.cwiseProduct(s).eval(); });
  shape.kind = "floor";
  shape.generator = generator_of(lengths, counts, element);
  centre(shape);
  return shape;
}

}  // namespace abut
