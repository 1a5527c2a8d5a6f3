#include "surface/overlap_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/index.hpp"
#include "surface/inside.hpp"
#include "surface/intersections.hpp"
#include "surface/signed_side.hpp"

namespace abut {
namespace {

using Vector = Eigen::Vector3d;
using What = OverlapPlace::What;

/// Of a surface that encloses nothing: cosine of normals that face each other (as rows of nodes
/// ask), and how far beside its rim a node may lie, in lengths of the facet (as those rows have
/// it).
constexpr double facing = 0.5, rim = 0.02;

/// An edge that passes through a thin body says more than a node of it that is in the other: by so
/// much, as shifts that free an edge may point aside by 35 degrees.
constexpr double much_deeper = 1.5;

class PlaceSearch {
 public:
  PlaceSearch(const PosedSurface& one, const PosedSurface& other, const OverlapChoice& choice)
      : choice_(choice),
        skin_(skin_of(std::array{one, other})),
        points_(points_of(one, other)),
        sides_(skin_),
        trees_(skin_, points_),
        closed_{is_closed(one), is_closed(other)} {
    trees_.refit(points_, points_);
  }

  std::vector<OverlapPlace> find() {
    boxes_ = {box_of_group(0), box_of_group(1)};
    for (const std::int32_t point : skin_.nodes) {
      const int surface = skin_.group[point];
      const Vector& x = points_[point];
      const SignedSide side = side_of(x, 1 - surface);
      if (is_in(x, side, 1 - surface, [&] { return sides_.point_normal(points_, point); }))
        keep(x, -side.gap, surface, What::node);
    }
    for (std::size_t f = 0; f < skin_.facets.size(); ++f) look_at(static_cast<std::int32_t>(f));
    sort();
    const double seen = found_.empty() ? 0.0 : much_deeper * found_.front().depth;
    if (const std::optional<OverlapPlace> edge =
            deepest_edge(std::max({seen, choice_.allowed[0], choice_.allowed[1]})))
      found_.insert(found_.begin(), *edge);
    return std::move(found_);
  }

 private:
  static std::vector<Vector> points_of(const PosedSurface& one, const PosedSurface& other) {
    std::vector<Vector> points;
    for (const PosedSurface* surface : {&one, &other})
      for (int n = 0; n < surface->node_count(); ++n) points.push_back(surface->point(n));
    return points;
  }
  Box box_of_group(int group) const {
    constexpr double far = std::numeric_limits<double>::infinity();
    Box box{{far, far, far}, {-far, -far, -far}};
    for (const std::int32_t point : skin_.nodes) {
      if (skin_.group[point] != group) continue;
      for (int i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], points_[point][i]);
        box.high[i] = std::max(box.high[i], points_[point][i]);
      }
    }
    return box;
  }
  /// By the box: of a surface that encloses nothing, what is in its body may lie beside it.
  bool may_be_in(const Vector& x, int body) const {
    const double margin =
        std::max({choice_.allowed[0], choice_.allowed[1], closed_[body] ? 0.0 : choice_.reach});
    for (int i = 0; i < 3; ++i)
      if (x[i] < boxes_[body].low[i] - margin || x[i] > boxes_[body].high[i] + margin) return false;
    return true;
  }

  /// Deepest first, and nodes before what is as deep but for rounding.
  void sort() {
    constexpr double rounding = 1.0e-9;
    std::ranges::stable_sort(found_, std::ranges::greater{}, &OverlapPlace::depth);
    const auto first =
        std::ranges::find_if(found_, [](const OverlapPlace& p) { return p.what == What::node; });
    if (first == found_.end() || first->depth < (1.0 - rounding) * found_.front().depth) return;
    std::rotate(found_.begin(), first, first + 1);
  }

  void keep(const Vector& x, double depth, int surface, What what) {
    // middles of round surfaces lie as far off them as facets do
    const double allowed = what == What::facet ? std::max(choice_.allowed[0], choice_.allowed[1])
                                               : choice_.allowed[surface];
    if (depth > allowed) found_.push_back({depth, x, what, surface});
  }

  SignedSide side_of(const Vector& x, int body) const {
    constexpr double everywhere = std::numeric_limits<double>::infinity();
    SignedSide none;
    none.gap = everywhere;
    none.normal.setZero();
    if (!may_be_in(x, body)) return none;
    const std::int32_t facet =
        trees_.closest_facet(body, points_, x, closed_[body] ? everywhere : choice_.reach);
    return facet < 0 ? none : sides_.side(points_, x, std::span(&facet, 1));
  }

  /// Whether what is behind a facet is in its body. `normal`: of the own surface there.
  template <class Normal>
  bool is_in(const Vector& x, const SignedSide& side, int body, const Normal& normal) const {
    if (!side.inside() || closed_[body]) return side.inside();
    return normal().dot(side.normal) <= -facing && !(side.border && beside(x, side) > rim);
  }

  /// The middle of a facet: nodes of flush bodies lie on each other. Where it lies on a facet that
  /// looks the same way, both bodies are behind it.
  void look_at(std::int32_t facet) {
    const auto& f = skin_.facets[facet];
    const int surface = skin_.group[f[0]], body = 1 - surface, corners = skin_.facet_points();
    Vector x = Vector::Zero();
    for (int i = 0; i < corners; ++i) x += points_[f[i]] / corners;
    const Vector normal = sides_.facet_normal(points_, facet);
    const SignedSide side = side_of(x, body);
    if (is_in(x, side, body, [&] { return normal; })) keep(x, -side.gap, surface, What::facet);
    const bool flush = closed_[0] && closed_[1] && normal.dot(side.normal) > facing &&
                       std::abs(side.gap) <= choice_.allowed[surface];
    if (!flush) return;
    const Vector behind = x - 0.25 * length(facet) * normal;
    const double gap = std::max(side_of(behind, body).gap, side_of(behind, surface).gap);
    keep(behind, -gap, surface, What::facet);
  }

  /// How far a point lies beside its closest facet, in lengths of that facet.
  double beside(const Vector& x, const SignedSide& side) const {
    const auto& f = skin_.facets[side.facet];
    Vector way = x;
    for (int i = 0; i < skin_.facet_points(); ++i)
      way += side.weights[index(i + 1)] * points_[f[i]];
    const Vector n = sides_.facet_normal(points_, side.facet);
    return (way - way.dot(n) * n).norm() / length(side.facet);
  }
  double length(std::int32_t facet) const {  // of its longest edge
    const auto& f = skin_.facets[facet];
    double most = 0.0;
    for (int i = 0; i < skin_.facet_points(); ++i)
      most = std::max(most, (points_[f[i]] - points_[f[(i + 1) % skin_.facet_points()]]).norm());
    return most;
  }

  bool find_edges(double depth) {
    intersections(trees_, points_, depth, {}, edges_);
    return !edges_.empty();
  }

  /// Depths are those of intersections(): what a shift of an edge must exceed to free it.
  std::optional<OverlapPlace> deepest_edge(double known) {
    if (!find_edges(known)) return {};
    Intersection deepest = edges_.front();
    double beyond = 2.0 * known;
    while (find_edges(beyond)) {
      deepest = edges_.front();
      known = std::exchange(beyond, 2.0 * beyond);
    }
    constexpr int bisections = 12;  // three digits
    for (int i = 0; i < bisections; ++i) {
      const double middle = 0.5 * (known + beyond);
      if (find_edges(middle)) {
        deepest = edges_.front();
        known = middle;
      } else {
        beyond = middle;
      }
    }
    return OverlapPlace{known, place_of(deepest), What::edge, skin_.group[edge_of(deepest)[0]]};
  }
  std::array<std::int32_t, 2> edge_of(const Intersection& pair) const {
    if (skin_.dim == 3) return skin_.edges[pair.edge];
    return {skin_.facets[pair.edge][0], skin_.facets[pair.edge][1]};
  }
  Vector place_of(const Intersection& pair) const {
    const auto [p, q] = edge_of(pair);
    const Vector n = sides_.facet_normal(points_, pair.facet);
    const Vector& a = points_[skin_.facets[pair.facet][0]];
    const double from = n.dot(points_[p] - a), to = n.dot(points_[q] - a);
    const double part = from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
    return (1.0 - part) * points_[p] + part * points_[q];
  }

  OverlapChoice choice_;
  Skin skin_;
  std::vector<Vector> points_;
  SkinSides sides_;
  SkinTrees trees_;
  std::array<bool, 2> closed_;
  std::array<Box, 2> boxes_{};
  std::vector<Intersection> edges_;
  std::vector<OverlapPlace> found_;
};

}  // namespace

std::vector<OverlapPlace> overlap_places(const PosedSurface& one, const PosedSurface& other,
                                         const OverlapChoice& choice) {
  return PlaceSearch(one, other, choice).find();
}

bool is_before(const PosedSurface& surface, const Eigen::Vector3d& x, double distance) {
  if (surface.facet_count() == 0 || !is_closed(surface)) return false;
  const Skin skin = skin_of(std::array{surface});
  std::vector<Vector> points;
  for (int n = 0; n < surface.node_count(); ++n) points.push_back(surface.point(n));
  SkinTrees trees(skin, points);
  trees.refit(points, points);
  const std::int32_t facet = trees.closest_facet(0, points, x, distance);
  if (facet < 0) return false;
  const SignedSide side = SkinSides(skin).side(points, x, std::span(&facet, 1));
  return side.gap > 0.0 && side.gap < distance;
}

std::vector<OverlapPlace> parted_places(const std::vector<OverlapPlace>& places, double distance,
                                        int most) {
  std::vector<OverlapPlace> parted;
  for (const OverlapPlace& place : places) {
    if (static_cast<int>(parted.size()) == most) break;
    if (std::ranges::none_of(parted, [&](const OverlapPlace& before) {
          return (before.place - place.place).norm() <= distance;
        }))
      parted.push_back(place);
  }
  return parted;
}

}  // namespace abut
