#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/port.hpp"
#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// The facets of a partner's surface that a port may meet, as a surface of its own: a substep costs
/// what is near, whatever lies farther away. They are found with a margin, and hold until motions
/// have used it up.
class NearSurface {
 public:
  /// Both must outlive it.
  NearSurface(const PortGeometry& whole, const PortGeometry& own);

  /// The partner's displacements in a window [m] (levels, values of the whole).
  void follow(std::span<const double> u);
  /// The partner does not move in the window.
  bool stands() const { return stands_; }
  /// Whether what comes within `reach` [m] of the port is in it; `pose`: [m] (points, dim) of the
  /// port.
  bool holds(std::span<const double> pose, double reach) const;
  /// Finds it for the window that is followed: what may come within `reach`, with a margin of as
  /// much again; the facets of points that are `needed`; and those that it has, where it `grows`.
  void find(std::span<const double> pose, double reach, const std::vector<std::int32_t>& needed,
            bool grows);
  /// It is the whole surface from now on.
  void take_all();
  bool whole() const { return all_; }

  /// Its own numbers: places in the reference [m] (points, dim), facets, offsets.
  int dim = 3;
  bool round = false;
  std::vector<double> points;
  std::vector<std::int32_t> facets, offsets;

  int count() const { return static_cast<int>(points.size()) / dim; }
  /// Of the whole, ascending; empty: all of them. Never empty where it is a part.
  const std::vector<std::int32_t>& listed() const { return listed_; }
  /// Number of a point of it in the whole, and of a point of the whole in it; -1: not in it.
  std::int32_t in_whole(std::int32_t point) const { return all_ ? point : listed_[point]; }
  std::int32_t in_part(std::int32_t point) const { return all_ ? point : part_of_[point]; }
  /// Values (points, dim) of it among those of the whole.
  const std::vector<std::size_t>& values() const { return values_; }

 private:
  void number(const std::vector<char>& has);
  void list_values();

  const PortGeometry* whole_;
  const PortGeometry* own_;
  bool all_ = false, stands_ = false;
  std::vector<std::int32_t> listed_, part_of_;
  std::vector<std::int32_t> taken_;  // facets of the whole
  std::vector<std::size_t> values_;
  double margin_ = -1.0;          // [m] around the port, for the poses below; < 0: none known
  double moved_ = 0.0;            // [m] the partner's, at most, from made_ in the window
  std::vector<double> made_;      // [m] (values of the whole) displacements
  std::vector<double> made_own_;  // [m] (points, dim) the port's pose
  std::span<const double> u_;
  std::vector<double> pose_;  // [m] of the whole
  bool posed_ = false;        // its tree is that of made_
  BoxTree tree_, own_tree_;
  std::vector<FacetPair> pairs_;
};

}  // namespace abut
