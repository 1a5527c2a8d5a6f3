#include "tests/random/lattice.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace abut {

namespace {

double triple(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return a.dot(b.cross(c));
}

/// Six tetrahedra along the diagonal of a cell from its first corner: neighbours fit.
void split_hexahedron(const std::vector<int>& c, std::vector<std::vector<int>>& out) {
  // by the corners that a way along the edges from the first to the seventh passes
  for (const auto& [a, b] : {std::pair{1, 2}, {1, 5}, {3, 2}, {3, 7}, {4, 5}, {4, 7}})
    out.push_back({c[0], c[a], c[b], c[6]});
}

/// The number of the node between two others, which is made when it is asked for first.
class Halves {
 public:
  explicit Halves(Shape& shape) : shape_(shape) {}
  int operator()(int a, int b) {
    const auto [at, fresh] = known_.emplace(std::array<int, 2>{std::min(a, b), std::max(a, b)},
                                            static_cast<int>(shape_.points.size()));
    if (fresh) {
      const Eigen::Vector3d middle = 0.5 * (shape_.points[a] + shape_.points[b]);
      shape_.points.push_back(middle);
    }
    return at->second;
  }

 private:
  Shape& shape_;
  std::map<std::array<int, 2>, int> known_;
};

}  // namespace

Shape lattice(Draw& draw, const std::string& element, std::array<int, 3> counts, bool round,
              const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) {
  Shape shape;
  shape.dim = element == "quad4" || element == "tri3" ? 2 : 3;
  shape.element = element;
  const int nx = counts[0], ny = counts[1], nz = shape.dim == 3 ? counts[2] : 0;
  const int wide = round ? nx : nx + 1;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i < wide; ++i)
        shape.points.push_back(place({double(i) / nx, double(j) / ny, nz ? double(k) / nz : 0.0}));
  const auto node = [&](int i, int j, int k) {
    return (k * (ny + 1) + j) * wide + (round ? i % nx : i);
  };
  for (int k = 0; k < std::max(nz, 1); ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        std::vector<int> c = {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                              node(i, j + 1, k)};
        if (shape.dim == 3)
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            c.push_back(node(i + a, j + b, k + 1));
        if (element == "tri3" && draw.chance(0.5)) {
          shape.cells.insert(shape.cells.end(), {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}});
        } else if (element == "tri3") {
          shape.cells.insert(shape.cells.end(), {{c[0], c[1], c[3]}, {c[1], c[2], c[3]}});
        } else if (element == "tet4") {
          split_hexahedron(c, shape.cells);
        } else {
          shape.cells.push_back(c);
        }
      }
  orient(shape);
  return shape;
}

void refine_triangles(Shape& shape) {
  Halves half(shape);
  std::vector<std::vector<int>> cells;
  for (const std::vector<int>& c : std::exchange(shape.cells, {})) {
    const int a = half(c[0], c[1]), b = half(c[1], c[2]), d = half(c[2], c[0]);
    cells.insert(cells.end(), {{c[0], a, d}, {a, c[1], b}, {d, b, c[2]}, {a, b, d}});
  }
  shape.cells = std::move(cells);
}

void refine_tetrahedra(Shape& shape) {
  Halves half(shape);
  std::vector<std::vector<int>> cells;
  for (const std::vector<int>& c : std::exchange(shape.cells, {})) {
    const int a = half(c[0], c[1]), b = half(c[0], c[2]), d = half(c[0], c[3]);
    const int e = half(c[1], c[2]), f = half(c[1], c[3]), g = half(c[2], c[3]);
    cells.insert(cells.end(), {{c[0], a, b, d},
                               {a, c[1], e, f},
                               {b, e, c[2], g},
                               {d, f, g, c[3]},
                               {a, g, b, d},
                               {a, g, d, f},
                               {a, g, f, e},
                               {a, g, e, b}});
  }
  shape.cells = std::move(cells);
  orient(shape);
}

Shape prism(const Shape& flat, double depth, int layers) {
  Shape shape;
  shape.dim = 3;
  shape.element = "tet4";
  const int n = static_cast<int>(flat.points.size());
  for (int k = 0; k <= layers; ++k)
    for (Eigen::Vector3d x : flat.points) {
      x(2) = depth * k / layers;
      shape.points.push_back(x);
    }
  for (int k = 0; k < layers; ++k)
    for (std::vector<int> c : flat.cells) {
      std::ranges::sort(c);  // neighbours split their common side the same way
      for (int& node : c) node += k * n;
      shape.cells.push_back({c[0], c[1], c[2], c[2] + n});
      shape.cells.push_back({c[0], c[1], c[1] + n, c[2] + n});
      shape.cells.push_back({c[0], c[0] + n, c[1] + n, c[2] + n});
    }
  orient(shape);
  return shape;
}

void raise_order(Shape& shape) {
  Halves half(shape);
  const auto edges = edges_of(shape.element);
  for (std::vector<int>& cell : shape.cells)
    for (const auto& [a, b] : edges) cell.push_back(half(cell[a], cell[b]));
  shape.element = shape.dim == 2 ? "tri6" : "tet10";
}

void orient(Shape& shape) {
  const auto& x = shape.points;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (std::vector<int>& c : shape.cells) {
    if (shape.element == "tri3" && triple(x[c[1]] - x[c[0]], x[c[2]] - x[c[0]], up) < 0.0)
      std::swap(c[1], c[2]);
    if (shape.element == "tet4" &&
        triple(x[c[1]] - x[c[0]], x[c[2]] - x[c[0]], x[c[3]] - x[c[0]]) < 0.0)
      std::swap(c[1], c[2]);
  }
}

bool sound(const Shape& shape) {
  const auto& x = shape.points;
  const double small = 0.1;  // of the product of the edges: no corner that is nearly flat
  if (shape.element != "quad4" && shape.element != "hex8") return true;
  for (const std::vector<int>& c : shape.cells)
    for (int k = 0; k < static_cast<int>(c.size()); ++k) {
      const int base = k / 4 * 4, turn = base == 0 ? 1 : 3;
      const Eigen::Vector3d a = x[c[base + (k + turn) % 4]] - x[c[k]];
      const Eigen::Vector3d b = x[c[base + (k + 4 - turn) % 4]] - x[c[k]];
      const Eigen::Vector3d up =
          shape.dim == 2 ? Eigen::Vector3d::UnitZ().eval() : (x[c[(k + 4) % 8]] - x[c[k]]).eval();
      if (triple(a, b, up) < small * a.norm() * b.norm() * up.norm()) return false;
    }
  return true;
}

}  // namespace abut
