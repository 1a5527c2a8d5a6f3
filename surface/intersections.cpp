#include "surface/intersections.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace abut {
namespace {

using Vector = Eigen::Vector3d;
using Points = std::span<const Vector>;
using Facet = std::array<std::int32_t, 3>;

/// Ways to shift an edge: along faces and corners of a cube, every second bent off so that none
/// lies in a plane of another or of a scene. Any cone with an opening of 70 degrees, as that of a
/// cube's corner, has one. In the plane the first six are left out, and z.
constexpr std::size_t shift_count = 14;
const std::array<Vector, shift_count>& shifts() {
  static const std::array<Vector, shift_count> all = [] {
    std::array<Vector, shift_count> s;
    std::size_t n = 0;
    for (int d = 0; d < 3; ++d)
      for (const double sign : {1.0, -1.0}) s[n++] = sign * Vector::Unit(d);
    for (int corner = 0; corner < 8; ++corner)
      s[n++] = Vector(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.1234567, Vector(0.31, -0.72, 0.62).normalized()).toRotationMatrix();
    for (Vector& v : s) v = turn * v.normalized();
    return s;
  }();
  return all;
}

double volume(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether a segment goes through a triangle.
bool passes(const Vector& p, const Vector& q, const Vector& a, const Vector& b, const Vector& c) {
  if ((volume(a, b, c, p) > 0.0) == (volume(a, b, c, q) > 0.0)) return false;
  const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
  return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

/// Whether two segments of the plane cross.
bool segments_cross(const Vector& p, const Vector& q, const Vector& a, const Vector& b) {
  const auto side = [](const Vector& from, const Vector& to, const Vector& x) {
    return (to - from).cross(x - from).z() > 0.0;
  };
  return side(a, b, p) != side(a, b, q) && side(p, q, a) != side(p, q, b);
}

bool share_a_point(std::span<const std::int32_t> a, std::span<const std::int32_t> b) {
  return std::ranges::any_of(
      a, [b](std::int32_t p) { return p >= 0 && std::ranges::find(b, p) != b.end(); });
}

class Search {
 public:
  Search(const Skin& skin, Points points, double depth, const FeatureChoice& choice,
         std::vector<Intersection>& found)
      : skin_(skin), points_(points), depth_(depth), choice_(choice), found_(found) {}

  std::span<const std::int32_t> edge(std::int32_t place) const {
    if (skin_.dim == 2) return std::span(skin_.facets[place]).first(2);
    return skin_.edges[place];
  }

  void add_candidate(std::int32_t one, std::int32_t facet) {
    const std::span<const std::int32_t> e = edge(one);
    const Facet& f = skin_.facets[facet];
    if (share_a_point(e, f)) return;
    const auto given = [this](std::int32_t p) { return p < 0 || choice_.is_prescribed(p); };
    if (std::ranges::all_of(e, given) && std::ranges::all_of(f, given)) return;
    found_.push_back({one, facet});
  }

  /// Leaves of the candidates those that pass, edge by edge.
  void keep_what_passes() {
    std::ranges::sort(found_);
    std::size_t kept = 0;
    for (std::size_t begin = 0, end = 0; begin < found_.size(); begin = end) {
      while (end < found_.size() && found_[end].edge == found_[begin].edge) ++end;
      kept = keep_of_one(begin, end, kept);
    }
    found_.resize(kept);
  }

 private:
  /// Whether a candidate's edge passes through its facet when it is shifted.
  bool passes_shifted(const Intersection& pair, std::size_t shift) const {
    const std::span<const std::int32_t> e = edge(pair.edge);
    const Facet& f = skin_.facets[pair.facet];
    Vector by = shifts()[shift];
    if (skin_.dim == 2) by = Vector(by.x(), by.y(), 0.0).normalized();
    const Vector p = points_[e[0]] + depth_ * by, q = points_[e[1]] + depth_ * by;
    const Vector &a = points_[f[0]], &b = points_[f[1]];
    return skin_.dim == 2 ? segments_cross(p, q, a, b) : passes(p, q, a, b, points_[f[2]]);
  }
  std::size_t first_shift() const { return skin_.dim == 2 ? 6 : 0; }

  std::size_t keep_of_one(std::size_t begin, std::size_t end, std::size_t kept) {
    const std::span<const Intersection> candidates =
        std::span(std::as_const(found_)).subspan(begin, end - begin);
    unsigned all = 0;
    for (std::size_t s = first_shift(); s < shift_count; ++s) {  // most edges end with the first
      const auto passes_it = [this, s](const Intersection& pair) {
        return passes_shifted(pair, s);
      };
      if (std::ranges::none_of(candidates, passes_it)) return kept;
      all |= 1U << s;
    }
    passed_.clear();
    for (const Intersection& pair : candidates) {
      unsigned bits = 0;
      for (std::size_t s = first_shift(); s < shift_count; ++s)
        if (passes_shifted(pair, s)) bits |= 1U << s;
      passed_.push_back(bits);
    }
    pairs_.assign(candidates.begin(), candidates.end());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (passed_[i] == 0) continue;
      const Facet& facet = skin_.facets[pairs_[i].facet];
      unsigned here = 0;
      for (std::size_t j = 0; j < pairs_.size(); ++j)
        if (passed_[j] != 0 && share_a_point(facet, skin_.facets[pairs_[j].facet]))
          here |= passed_[j];
      if (here == all) found_[kept++] = pairs_[i];
    }
    return kept;
  }

  const Skin& skin_;
  Points points_;
  double depth_;
  const FeatureChoice& choice_;
  std::vector<Intersection>& found_;
  std::vector<unsigned> passed_;     // of one edge's candidates
  std::vector<Intersection> pairs_;  // the candidates themselves
};

}  // namespace

void intersections(SkinTrees& trees, Points points, double depth, const FeatureChoice& choice,
                   std::vector<Intersection>& found) {
  const Skin& skin = trees.skin();
  trees.refit(points, points);
  found.clear();
  Search search(skin, points, depth, choice, found);
  const auto either_way = [&search](std::int32_t k, std::int32_t n) {
    search.add_candidate(k, n);
    search.add_candidate(n, k);
  };
  const auto edge_facet = [&search](std::int32_t k, std::int32_t n) { search.add_candidate(k, n); };
  for (int g = 0; g < skin.groups; ++g) {
    for (int h = g; h < skin.groups; ++h) {
      if (!choice.allows(g, h, skin.groups)) continue;
      if (skin.dim == 2) {
        trees.visit(SkinTrees::facets, g, SkinTrees::facets, h, depth, either_way);
        continue;
      }
      trees.visit(SkinTrees::edges, g, SkinTrees::facets, h, depth, edge_facet);
      if (h != g) trees.visit(SkinTrees::edges, h, SkinTrees::facets, g, depth, edge_facet);
    }
  }
  search.keep_what_passes();
}

}  // namespace abut
