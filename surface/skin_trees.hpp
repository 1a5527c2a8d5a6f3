#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/box_pairs.hpp"
#include "surface/skin.hpp"

namespace abut {

/// Which pairs of features are looked at.
struct FeatureChoice {
  // (groups, groups) symmetric, 1: looked at; its diagonal: a group against itself. Empty: any two
  // different groups.
  std::vector<std::uint8_t> allowed;
  // by point, 1: its motion is given; empty: none is. Pairs of such points alone are left out.
  std::vector<std::uint8_t> prescribed;

  bool allows(int a, int b, int groups) const {
    return allowed.empty() ? a != b : allowed[index(a) * index(groups) + index(b)] != 0;
  }
  bool is_prescribed(std::int32_t point) const {
    return !prescribed.empty() && prescribed[index(point)] != 0;
  }
};

/// Trees of boxes over a skin's nodes, edges and facets, one of each for a group. Their structure
/// is made once for the places that it is made with; boxes follow, without allocation. The skin
/// must live.
class SkinTrees {
 public:
  enum Kind : std::uint8_t { nodes, edges, facets };

  SkinTrees(const Skin& skin, std::span<const Eigen::Vector3d> points);

  const Skin& skin() const { return skin_; }
  /// The boxes over straight ways between two poses.
  void refit(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to);
  /// Calls visit(k, n), places in the skin's lists, for features of one kind in a group and of
  /// another in another group whose boxes are not farther apart than `reach` [m] along any axis.
  template <class Visit>
  void visit(Kind kind, int group, Kind other_kind, int other_group, double reach,
             const Visit& visit) const {
    const Forest &a = forests_[index(kind)], &b = forests_[index(other_kind)];
    const std::int32_t first = a.begin[index(group)], second = b.begin[index(other_group)];
    const auto call = [&visit, first, second](std::int32_t k, std::int32_t n) {
      visit(first + k, second + n);
    };
    const auto meet = [reach](const Box& x, const Box& y) { return within(x, y, reach); };
    if (kind == other_kind && group == other_group)
      visit_own_pairs(a.trees[index(group)], meet, call);
    else
      visit_pairs(a.trees[index(group)], b.trees[index(other_group)], meet, call);
  }
  /// The facet of a group that is closest to x in the pose `points`, which the boxes must hold; of
  /// facets at the same distance the first. -1: the group has none within reach [m].
  std::int32_t closest_facet(int group, std::span<const Eigen::Vector3d> points,
                             const Eigen::Vector3d& x, double reach) const;

 private:
  /// All features of a kind. Those of a group follow each other, as points do.
  struct Forest {
    std::vector<std::int32_t> begin;  // (groups + 1) of a group's features
    std::vector<BoxTree> trees;       // (groups)
    std::vector<Box> boxes;           // of all features
  };
  static bool within(const Box& a, const Box& b, double reach) {
    return a.low[0] - reach <= b.high[0] && b.low[0] - reach <= a.high[0] &&
           a.low[1] - reach <= b.high[1] && b.low[1] - reach <= a.high[1] &&
           a.low[2] - reach <= b.high[2] && b.low[2] - reach <= a.high[2];
  }
  void set_boxes(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to);

  const Skin& skin_;
  std::array<Forest, 3> forests_;  // by kind
};

}  // namespace abut
