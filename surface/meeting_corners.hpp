#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"
#include "surface/surface_rows.hpp"
#include "surface/wedges.hpp"

namespace abut {

struct CornerOptions {
  double facing = 0.5;  // of pairs that a mortar method joins (MortarOptions)
  double way = 0.0;     // [m] that the two have come closer at most, from `before` on
};

/// A surface in its pose and where it was when it was not yet pressed through the other.
struct CornerSurface {
  PosedSurface now, before;
  const Wedges* wedges = nullptr;
};

/// Where sharp edges or corners of two surfaces meet, averages over facets mean nothing: a facet
/// sees the plane of another beyond that one's edge. What keeps two wedges apart is one plane, of
/// their facets or along both edges: that which separated them best before,
///   s(n) = min n.x over the wedge of K - max n.y over that of N.
/// Where facets of both lie along it, they are joined as elsewhere. Else their pairs are dropped,
/// and rows of single points hold the two: nodes of one edge before a facet beside the other, or
/// an edge across an edge. Planes that separate nearly as well share the normal, so that it turns
/// steadily around a corner.
class MeetingCorners {
 public:
  /// `pairs`: candidates, ordered. What the surfaces view must live until join().
  void find(const CornerSurface& k, const CornerSurface& n, std::span<const FacetPair> pairs,
            const CornerOptions& options);
  bool drops(FacetPair pair) const;
  int count() const { return static_cast<int>(rows_.size()); }
  /// Appends the rows, in the place of those of their nodes.
  void join(SurfaceRows& rows);
  /// Pairs of wedges for which planes were looked for so far: for each one once as long as the two
  /// surfaces were at the same places before.
  std::size_t searches() const { return searches_; }

 private:
  enum class Kind { n_plane, k_plane, edges };
  using Ends = std::array<std::int32_t, 2>;
  struct Plane {
    Kind kind = Kind::n_plane;
    std::int32_t facet = -1;  // whose plane it is
    Ends k{}, n{};            // edges that it lies along
    double sign = 1.0;        // of the normal
    Eigen::Vector3d normal;   // out of N into K, before
    double apart = 0.0;       // [m] s of it
  };
  struct Verdict {
    std::int32_t k = 0, n = 0;  // wedges
    bool told = false;          // a plane that means something was found
    bool joined = false;        // facets of both lie along it
    bool crosses = false;       // edge across edge, near
    bool whole = false;         // what joins them, and along what, has been looked for
    std::size_t found = 0;      // of found_
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };
  struct Found {  // planes between two wedges, of the places before alone
    std::int32_t k = 0, n = 0;
    double size = 0.0;                 // [m] size_
    double of_facets = 0.0;            // [m] by which a facet's plane separates them at most
    bool whole = false;                // edges have been looked at, too
    double most = 0.0;                 // [m] most_ then
    std::size_t first = 0, count = 0;  // planes_, of kept_
  };
  struct Side {  // of a row: nodes and their shares
    int count = 0;
    std::array<std::int32_t, 4> nodes{};
    std::array<double, 4> shares{};
  };
  struct Row {
    Kind kind = Kind::n_plane;
    Side k, n;
    Eigen::Vector3d normal;
    double apart = 0.0;
  };

  static std::pair<std::int32_t, std::int32_t> wedges(const Verdict& v) { return {v.k, v.n}; }
  /// [m] What is farther apart has no row yet.
  double reach() const;
  void find_verdicts(std::span<const FacetPair> pairs);
  void recall_found();
  std::size_t find_planes(std::int32_t one, std::int32_t two);
  void find_all_planes(const Verdict& verdict);
  void judge(Verdict& verdict);
  void judge_whole(Verdict& verdict);
  /// Of a wedge of K's, ordered by those of N's.
  std::span<Verdict> verdicts_of(std::int32_t k);
  bool is_dropped(FacetPair pair);
  void look_at_facets(const Wedge& a, const Wedge& b);
  void look_along(Plane plane);
  void look_across(const Ends& one, const Ends& two);
  void keep(const Plane& plane);
  double worst() const;
  Eigen::Vector3d normal_now(const Plane& plane) const;
  const Plane* joining(const Plane& best, const Wedge& a, const Wedge& b) const;
  void add_nodes(const Plane& best, const Wedge& of_nodes, const Wedge& of_facets);
  bool add_crossing(const Plane& best, const Wedge& a, const Wedge& b);
  bool add(const Row& row);
  bool is_again(const Row& known, const Row& row) const;
  bool has_row(const SparseRows& of, std::size_t r, Kind kind) const;
  double gap(const Row& row) const;
  static Eigen::Vector3d place(const PosedSurface& surface, const Side& side);
  static void append(Side side, SparseRows& to);

  /// Of one side of the two wedges that are looked at, before.
  struct Extent {
    std::vector<Eigen::Vector3d> points;  // [m] of its nodes
    Eigen::Vector3d edge;                 // [m] its own, from end to end
    std::array<bool, 2> beyond{};         // goes straight on at an end

    void set(const PosedSurface& surface, const Wedge& wedge);
    /// [m] of all of it along a normal, least and most.
    std::array<double, 2> along(const Eigen::Vector3d& normal) const;
    bool is_on_both_sides(const Eigen::Vector3d& normal, double plane, double far) const;
  };
  /// Unit normals of a surface's facets, each found when it is first asked for.
  struct Normals {
    std::vector<Eigen::Vector3d> of;
    std::vector<char> known;

    void clear(const PosedSurface& surface);
    const Eigen::Vector3d& at(const PosedSurface& surface, std::int32_t facet);
  };

  CornerSurface k_, n_;
  Normals k_before_, n_before_, k_now_, n_now_;
  Extent k_extent_, n_extent_;
  CornerOptions options_;
  double size_ = 0.0;  // [m] of the edges looked at
  std::vector<Plane> planes_;
  double most_ = 0.0;       // [m] by which one of them separates
  Eigen::Vector3d shared_;  // normals of planes that separate nearly as well as the best
  // What was found of places before, which several looks have in common: that of looks before this
  // one ordered by wedges, this one's behind.
  std::vector<Found> found_;
  std::size_t ordered_ = 0;
  std::vector<Plane> kept_;
  std::vector<double> k_places_, n_places_;  // [m] that it is of
  const Wedges *k_wedges_ = nullptr, *n_wedges_ = nullptr;
  std::size_t searches_ = 0;
  std::vector<Verdict> verdicts_;
  std::vector<std::size_t> begins_;  // of the verdicts of each wedge of K's, and their end
  bool crosses_ = false;             // one of them does
  std::vector<FacetPair> dropped_;
  std::vector<Row> rows_;
  SurfaceRows others_;
};

}  // namespace abut
