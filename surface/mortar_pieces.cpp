#include "surface/mortar_pieces.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "base/index.hpp"

namespace abut {
namespace {

/// How many times larger than their sum the terms of a dual function's integral may be: with three
/// digits lost, rows are still exact to 1e-13. Nine on a whole quadrilateral; more than this where
/// N covers less than some hundredth of a facet, away from its edges.
constexpr double most_cancellation = 1.0e3;

/// Of the facet's area: what N covers less of while some of N is out of reach there has no dual
/// functions. They would lead N on beyond the part that is near, on curved faces through K.
constexpr double whole = 0.999;

/// Cosine between the normals of facets: what N turns away from by more, an edge of K that sinks
/// in, leaves the reach by its slope and not by N's curve. Dual functions hold such an edge at its
/// own place, shape functions would average it with what stands off.
constexpr double steep = 0.7;

/// Coefficients A of the dual functions, Phi = A N, where D and w are those of the facet; false
/// when round-off would show in them.
bool dual_basis(const Eigen::Matrix4d& d, const Shape4& w, int count, Eigen::Matrix4d& a) {
  Eigen::Matrix4d full = d;
  for (int i = count; i < 4; ++i) full(i, i) = 1.0;
  const Eigen::LLT<Eigen::Matrix4d> factors(full);
  if (factors.info() != Eigen::Success) return false;
  for (int i = 0; i < 4; ++i) a.col(i) = factors.solve(Eigen::Vector4d::Unit(i));
  a = w.asDiagonal() * a;
  const Shape4 terms = a.cwiseAbs() * w;
  for (int i = 0; i < count; ++i)
    if (!(terms[i] <= most_cancellation * w[i])) return false;
  return true;
}

/// From integrals with shape functions to integrals with dual functions.
void to_dual(const GroundFacet& ground, double covered, double dual_from, MortarFacet& facet,
             std::span<MortarPiece> pieces) {
  Eigen::Matrix4d a;
  facet.dual = covered > dual_from * ground.area &&
               dual_basis(facet.t, facet.weight, ground.corners.count, a);
  if (!facet.dual) return;
  facet.t = facet.weight.asDiagonal();
  for (MortarPiece& piece : pieces) {
    piece.p = a * piece.p;
    piece.share = a * piece.share;
  }
}

}  // namespace

void mortar_pieces(const PosedSurface& k, const PosedSurface& n, std::span<const FacetPair> pairs,
                   const MortarOptions& options, MortarPieces& out) {
  out.facets.clear();
  out.pieces.clear();
  FacetOverlap overlap;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const GroundFacet ground(corners(k, pairs[begin].k), k.round);
    MortarFacet facet;
    facet.facet = pairs[begin].k;
    facet.first = static_cast<std::int32_t>(out.pieces.size());
    facet.t.setZero();
    facet.weight.setZero();
    double covered = 0.0, faces = 0.0;
    bool leaves = false;
    for (end = begin; end < pairs.size() && pairs[end].k == pairs[begin].k; ++end) {
      const Corners partner = corners(n, pairs[end].n);
      const Eigen::Vector3d normal = mean_normal(partner);
      if (!(normal.dot(ground.plane.normal) <= -options.facing)) continue;
      const bool joined = integrate(ground, partner, options.reach, options.quadrature, overlap);
      leaves = leaves || overlap.gap > options.reach;
      if (!joined) continue;
      out.pieces.push_back({pairs[end].n, overlap.mixed, overlap.moments, normal});
      facet.t += overlap.own;
      facet.weight += overlap.moments;
      covered += overlap.area;
      faces = std::max(faces, -normal.dot(ground.plane.normal));
    }
    facet.last = static_cast<std::int32_t>(out.pieces.size());
    if (facet.first == facet.last) continue;
    const bool rim = leaves && faces > steep && covered < whole * ground.area;
    const double least = rim ? 1.0 : options.dual_from;
    to_dual(ground, covered, least, facet, std::span(out.pieces).subspan(index(facet.first)));
    out.facets.push_back(facet);
  }
}

}  // namespace abut
