#include "coordinator/init/facing_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/index.hpp"

namespace abut {
namespace {

constexpr double outside = 1.0e-9;  // of a piece: how far beyond its edges it is still met

/// Pieces by the cells of a raster across x that their boxes cover, and where lines along x meet
/// them.
class Raster {
 public:
  explicit Raster(const PlacedSurface& surface) : surface_(surface) {
    const double pieces = static_cast<double>(surface.pieces.size()) / surface.corners;
    const double fine = surface.corners == 2 ? pieces : std::sqrt(pieces);
    count_ = std::clamp(static_cast<int>(fine / 2.0), 1, 300);
    for (const std::size_t d : {1u, 2u}) {
      low_[d - 1] = high_[d - 1] = point(surface.used_nodes.front())[d];
      for (const int node : surface.used_nodes) {
        low_[d - 1] = std::min(low_[d - 1], point(node)[d]);
        high_[d - 1] = std::max(high_[d - 1], point(node)[d]);
      }
    }
    cells_.resize(index(count_) * index(count_));
    const std::size_t corners = index(surface.corners);
    for (std::size_t piece = 0; piece < surface.pieces.size() / corners; ++piece) insert(piece);
  }

  /// Calls `each` with the x at which a line along x through (y, z) meets a piece.
  template <class Each>
  void meet(double y, double z, const Each& each) const {
    if (y < low_[0] || y > high_[0] || z < low_[1] || z > high_[1]) return;
    for (const std::size_t piece : cells_[cell(y, 0) * index(count_) + cell(z, 1)]) {
      const std::optional<double> x =
          surface_.corners == 2 ? on_segment(piece, y) : on_triangle(piece, y, z);
      if (x) each(*x);
    }
  }

 private:
  const double* point(int node) const { return &surface_.points[3 * index(node)]; }
  const double* corner(std::size_t piece, std::size_t k) const {
    return point(surface_.pieces[piece * index(surface_.corners) + k]);
  }
  std::size_t cell(double value, std::size_t axis) const {
    const double width = high_[axis] - low_[axis];
    if (width <= 0.0) return 0;
    const int k = static_cast<int>((value - low_[axis]) / width * count_);
    return index(std::clamp(k, 0, count_ - 1));
  }

  void insert(std::size_t piece) {
    std::array<double, 2> low, high;
    for (const std::size_t axis : {0u, 1u}) {
      low[axis] = high[axis] = corner(piece, 0)[axis + 1];
      for (std::size_t k = 1; k < index(surface_.corners); ++k) {
        low[axis] = std::min(low[axis], corner(piece, k)[axis + 1]);
        high[axis] = std::max(high[axis], corner(piece, k)[axis + 1]);
      }
    }
    for (std::size_t i = cell(low[0], 0); i <= cell(high[0], 0); ++i)
      for (std::size_t j = cell(low[1], 1); j <= cell(high[1], 1); ++j)
        cells_[i * index(count_) + j].push_back(piece);
  }

  std::optional<double> on_segment(std::size_t piece, double y) const {
    const double *a = corner(piece, 0), *b = corner(piece, 1);
    if (a[1] == b[1]) return std::nullopt;  // its ends are nodes themselves
    const double s = (y - a[1]) / (b[1] - a[1]);
    if (s < -outside || s > 1.0 + outside) return std::nullopt;
    return a[0] + s * (b[0] - a[0]);
  }

  std::optional<double> on_triangle(std::size_t piece, double y, double z) const {
    const double *a = corner(piece, 0), *b = corner(piece, 1), *c = corner(piece, 2);
    const double twice = (b[1] - a[1]) * (c[2] - a[2]) - (c[1] - a[1]) * (b[2] - a[2]);
    const double size = std::hypot(b[1] - a[1], b[2] - a[2]) * std::hypot(c[1] - a[1], c[2] - a[2]);
    if (std::abs(twice) <= outside * size) return std::nullopt;  // seen from its edge
    const double s = ((y - a[1]) * (c[2] - a[2]) - (c[1] - a[1]) * (z - a[2])) / twice;
    const double t = ((b[1] - a[1]) * (z - a[2]) - (y - a[1]) * (b[2] - a[2])) / twice;
    if (s < -outside || t < -outside || s + t > 1.0 + outside) return std::nullopt;
    return a[0] + s * (b[0] - a[0]) + t * (c[0] - a[0]);
  }

  const PlacedSurface& surface_;
  int count_ = 1;  // of cells along each axis
  std::array<double, 2> low_{}, high_{};
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

PlacedSurface placed_surface(const Mesh& mesh, const std::vector<double>& position, double scale) {
  PlacedSurface surface;
  const std::size_t dim = index(mesh.dim);
  surface.corners = mesh.dim;
  surface.points.assign(3 * index(mesh.node_count()), 0.0);
  for (std::size_t node = 0; node < index(mesh.node_count()); ++node)
    for (std::size_t d = 0; d < dim; ++d)
      surface.points[3 * node + d] = scale * mesh.points[node * dim + d] + position[d];
  std::set<int> used;
  for (const Facet& facet : mesh.side("boundary")) {
    const std::vector<std::int32_t> nodes = mesh.nodes_of(facet);
    const Element& cell = *mesh.blocks[index(facet.block)].element;
    const std::size_t corners = index(element_named(cell.facet_name).corner_count());
    for (std::size_t k = 0; k < corners; ++k) used.insert(nodes[k]);
    for (std::size_t k = 1; k + dim - 1 <= corners; ++k) {  // a fan around the first corner
      surface.pieces.push_back(nodes[0]);
      for (std::size_t j = 0; j + 1 < dim; ++j) surface.pieces.push_back(nodes[k + j]);
    }
  }
  surface.used_nodes.assign(used.begin(), used.end());
  return surface;
}

double facing_distance(const PlacedSurface& behind, const PlacedSurface& ahead) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&least](const PlacedSurface& from, const PlacedSurface& at, double sign) {
    const Raster raster(at);
    for (const int node : from.used_nodes) {
      const double* p = &from.points[3 * index(node)];
      raster.meet(p[1], p[2], [&](double x) { least = std::min(least, sign * (x - p[0])); });
    }
  };
  look(behind, ahead, 1.0);
  look(ahead, behind, -1.0);
  return least;
}

}  // namespace abut
