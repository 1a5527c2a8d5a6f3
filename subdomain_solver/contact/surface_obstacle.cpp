#include "subdomain_solver/contact/surface_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/force_means.hpp"
#include "contract/kernel.hpp"

namespace abut {

SurfaceObstacle::SurfaceObstacle(std::size_t port, std::size_t partner, const PortGeometry& own,
                                 const Partner& met, std::string body)
    : port_(port),
      partner_(partner),
      own_(own),
      met_(&met),
      body_(std::move(body)),
      reach_(longest_edge(posed(own, own.points))),
      edges_(met.surface, own.spacing, own.spacing),
      own_edges_(own, reach_, met.surface.spacing),
      wedges_(posed(met.surface)),
      own_wedges_(posed(own)),
      near_(met.surface, own) {
  options_.reach = reach_;
  build(own_tree_, posed(own), 0.0);
  if (!met.law.points) return;
  own_nodes_.resize(index(own.count()));
  std::iota(own_nodes_.begin(), own_nodes_.end(), 0);
}

void SurfaceObstacle::impose(const BoundaryData& data, const Partner& met, const Substeps& grid,
                             std::span<const double> pose, std::span<const double> reaction) {
  met_ = &met;
  motion_ = nullptr;
  if (partner_ >= data.obstacles.size() || data.obstacles[partner_].empty()) return;
  motion_ = &data.obstacles[partner_].motion;
  grid_ = grid;
  const bool whole = motion_->points.empty() && index(motion_->width) == width();
  if (!whole || motion_->u.size() != motion_->size() * width()) {
    throw RunError("an obstacle before a surface tells another number of points than the partner's",
                   fmt::format("body '{}'", body_), "Give its displacement at all of them.");
  }
  near_.follow(motion_->u);
  find_near(pose, reaction, false);
  if (!yields()) return;
  const PortKernel& kernel = met_->kernel;
  find_zone();
  if (index(kernel.count() + 1) < motion_->size() || index(kernel.width) != zone_.size() ||
      kernel.patterns != kernel.width || kernel.begin.size() != kernel.displacement.size()) {
    throw RunError("an obstacle that gives way has a kernel that is too short or of other points",
                   fmt::format("body '{}'", body_),
                   "Give its motion at its own substeps, with the kernel of as many.");
  }
  const std::vector<double> levels = levels_of(grid);
  parts_ = force_means(motion_->time, levels);
  leans_ = !kernel.compliance.empty() && motion_->time != levels;
  taken_.assign(motion_->size() * zone_.size(), 0.0);
  if (motion_->f.empty()) return;
  for (std::size_t l = 0; l < motion_->size(); ++l)
    for (std::size_t v = 0; v < zone_.size(); ++v)
      taken_[l * zone_.size() + v] = -motion_->f[l * width() + zone_[v]];
}

/// What presses, gives way or may come into reach. Edges are those of the whole.
void SurfaceObstacle::find_near(std::span<const double> pose, std::span<const double> reaction,
                                bool grows) {
  const std::vector<std::int32_t>& kernel = met_->kernel.points;
  const double reach = options_.reach;
  const auto is_near = [this](std::int32_t point) { return near_.in_part(point) >= 0; };
  needed_.clear();
  if (yields()) needed_ = kernel;
  for (std::size_t v = 0; v < reaction.size(); ++v)
    if (reaction[v] != 0.0) needed_.push_back(static_cast<std::int32_t>(v / index(near_.dim)));
  std::ranges::sort(needed_);
  const bool whole = edges_.any() || (yields() && kernel.empty());
  if (near_.holds(pose, reach) && (near_.whole() || !whole) &&
      std::ranges::all_of(needed_, is_near))
    return;
  if (whole)
    near_.take_all();
  else
    near_.find(pose, reach, needed_, grows);
  build(tree_, posed(near_), 0.0);
  fitted_.clear();
}

/// Which values of the partner's surface its kernel is of.
void SurfaceObstacle::find_zone() {
  const std::vector<std::int32_t>& points = met_->kernel.points;
  const std::size_t dim = index(met_->surface.dim);
  zone_.clear();
  zone_near_.clear();
  in_zone_.assign(near_.points.size(), -1);
  for (std::size_t v = 0; v < (points.empty() ? width() : points.size() * dim); ++v) {
    const std::int32_t point =
        points.empty() ? static_cast<std::int32_t>(v / dim) : points[v / dim];
    zone_.push_back(index(point) * dim + v % dim);
    zone_near_.push_back(index(near_.in_part(point)) * dim + v % dim);
    in_zone_[zone_near_.back()] = static_cast<int>(v);
  }
}

/// Earlier reactions are known, this substep's goes on being the later ones' guess [M.92].
void SurfaceObstacle::aim(int i, std::span<const double> reaction, bool turned) {
  const std::size_t z = zone_.size(), levels = motion_->size(), columns = index(grid_.count + 1);
  held_ = turned && std::ranges::any_of(reaction, [](double force) { return force != 0.0; });
  turned_ = turned;
  chosen_ = false;
  begin_ = i <= 1 ? grid_.begin : grid_.time(i - 1);
  find_travel(i);
  if (!yields()) return;
  memory_.assign(z, 0.0);
  if (i == 0) return;
  const std::size_t last = index(i - 1);
  for (std::size_t l = 0; l < levels; ++l) {
    const double part = parts_[l * columns + last];
    for (std::size_t v = 0; part != 0.0 && v < z; ++v)
      taken_[l * z + v] += part * reaction[zone_[v]];
  }
  later_.assign(levels, 0.0);
  for (std::size_t l = 0; l < levels; ++l)
    for (std::size_t j = index(i); j < columns; ++j) later_[l] += parts_[l * columns + j];
  give_.assign(met_->kernel.per_step(), 0.0);
  const double time = grid_.time(i);
  const auto after = std::ranges::lower_bound(motion_->time, time) - motion_->time.begin();
  const int next =
      static_cast<int>(std::clamp<std::ptrdiff_t>(after, 1, std::ssize(motion_->time) - 1));
  const double before = motion_->time[next - 1], end = motion_->time[next];
  const double share = std::clamp((time - before) / (end - before), 0.0, 1.0);
  recall(next, share);
  find_give(next, share);
  if (share < 1.0) {
    recall(next - 1, 1.0 - share);
    find_give(next - 1, 1.0 - share);
  }
  if (!leans_) return;
  lean(next, share);
  if (share < 1.0) lean(next - 1, 1.0 - share);
  for (std::size_t k = 0; k < give_.size(); ++k) give_[k] += met_->kernel.compliance[k];
}

/// Takes from a level's share what its mean force leans on the surface alone, for the force of the
/// instant does so in its place  [M.127].
void SurfaceObstacle::lean(int level, double share) {
  const std::size_t z = zone_.size(), from = index(level) * z;
  const std::vector<double>& compliance = met_->kernel.compliance;
  leaning_.assign(z, 0.0);
  for (std::size_t f = 0; f < z; ++f) {
    leaning_[f] = motion_->f.empty() ? 0.0 : motion_->f[index(level) * width() + zone_[f]];
    if (level > 0) leaning_[f] += taken_[from + f];  // else what pressed at the begin
  }
  add_moved(met_->kernel, compliance, -share, leaning_, memory_);
  const double part = level > 0 ? share * later_[level] : 0.0;
  for (std::size_t k = 0; part != 0.0 && k < give_.size(); ++k) give_[k] -= part * compliance[k];
}

/// Adds a share of what earlier reactions have moved the surface at a level.
void SurfaceObstacle::recall(int level, double share) {
  const std::size_t z = zone_.size();
  for (int at = 0; at <= level && level > 0; ++at) {
    const bool at_begin = at == 0;
    add_response(met_->kernel, at_begin ? level - 1 : level - at, at_begin, share,
                 std::span(taken_).subspan(index(at) * z, z), memory_);
  }
}

/// Adds a share of what this substep's reaction moves the surface at a level.
void SurfaceObstacle::find_give(int level, double share) {
  for (int at = 0; at <= level && level > 0; ++at) {
    const double part = share * later_[at];
    if (part == 0.0) continue;
    const bool at_begin = at == 0;
    const std::span<const double> answer =
        response(met_->kernel, at_begin ? level - 1 : level - at, at_begin);
    for (std::size_t k = 0; k < give_.size(); ++k) give_[k] += part * answer[k];
  }
}

void SurfaceObstacle::find_travel(int i) {
  travel_ = 0.0;
  if (i == 0 || near_.stands()) return;
  before_.resize(width());
  given_.resize(width());
  motion_->interpolate(motion_->u, i == 1 ? grid_.begin : grid_.time(i - 1), before_);
  motion_->interpolate(motion_->u, grid_.time(i), given_);
  for (std::size_t v = 0; v < width(); ++v)
    travel_ = std::max(travel_, std::abs(given_[v] - before_[v]));
}

void SurfaceObstacle::place(double time) {
  time_ = time;
  given_.resize(near_.points.size());
  free_.resize(near_.points.size());
  motion_->interpolate(motion_->u, time, near_.values(), given_);
  for (std::size_t v = 0; v < free_.size(); ++v) free_[v] = near_.points[v] + given_[v];
  for (std::size_t v = 0; yields() && v < zone_.size(); ++v) free_[zone_near_[v]] += memory_[v];
  if (corners_may_meet()) find_pose_before();
}

void SurfaceObstacle::find_pose_before() {
  before_.resize(given_.size());
  motion_->interpolate(motion_->u, begin_, near_.values(), before_);
  pose_before_ = free_;
  for (std::size_t v = 0; v < free_.size(); ++v) pose_before_[v] += before_[v] - given_[v];
}

void SurfaceObstacle::give_way(std::span<const double> reaction) {
  pose_ = free_;
  if (!yields()) return;
  const std::size_t z = zone_.size();
  leaning_.resize(z);
  moved_.resize(z);
  for (std::size_t v = 0; v < z; ++v) {
    leaning_[v] = reaction[zone_[v]];
    moved_[v] = pose_[zone_near_[v]];
  }
  add_moved(met_->kernel, give_, 1.0, leaning_, moved_);
  for (std::size_t v = 0; v < z; ++v) pose_[zone_near_[v]] = moved_[v];
}

/// Once in a substep, with trees and pairs of its first look. Before what is round, own edges of
/// facets that lie along it do not matter, nor those that are farther from it.
void SurfaceObstacle::choose_side(std::span<const double> pose) {
  constexpr double as_near = 0.015;  // of a facet: below, nodes of both are there
  chosen_ = true;
  if (turned_ && held_) return;
  turned_ = false;
  if (pairs_.empty()) return;
  const double reach = options_.reach;
  const EdgesNear its = edges_.near(pose_, posed(own_, pose), own_tree_, reach);
  if (!its.any()) return;
  const EdgesNear own = own_edges_.near(pose, posed(near_, pose_), tree_, reach);
  turned_ = !own.any() || (its.sharp == EdgesNear::none && own.bent == EdgesNear::none &&
                           own.leaning > its.bent + as_near * own_.spacing);
}

/// Rows of the port's nodes, each for itself [M.95].
void SurfaceObstacle::join_points(const PosedSurface& own, const PosedSurface& other) {
  PointRowOptions options;
  options.reach = options_.reach;
  point_rows(own, own_nodes_, other, tree_, options, point_buffers_, rows_);
}

/// Pairs that are behind each other by more than what bodies have gone since the begin are few:
/// sides of thin bodies that look away from each other.
void SurfaceObstacle::leave_out_far_sides(const PosedSurface& k, std::span<const double> begin,
                                          const PosedSurface& n, double way) {
  constexpr double thinnest = 1.0e-3;  // of a facet: bodies are not thinner
  const double depth = thinnest * own_.spacing;
  const bool any = std::ranges::any_of(
      pairs_, [&](const FacetPair& pair) { return is_behind(k, n, pair, way + depth); });
  if (!corners_may_meet() && any) find_pose_before();
  if (any)
    far_sides_.leave_out(posed(k, begin), posed(n, pose_before_), depth, pairs_);
  else
    far_sides_.forget();
}

/// Rows of averages, and of single points where edges or corners of both meet [M.104].
void SurfaceObstacle::join_averages(const PosedSurface& k, std::span<const double> begin,
                                    const PosedSurface& n, double way) {
  if (!turned_ || !chosen_ || corners_may_meet()) {
    overlapping_pairs(own_tree_, tree_, pairs_);
    leave_out_far_sides(k, begin, n, way);
  }
  if (!chosen_) choose_side(k.points);
  if (corners_may_meet())
    corners_.find({k, posed(k, begin), &own_wedges_}, {n, posed(n, pose_before_), &wedges_}, pairs_,
                  {options_.facing, way});
  if (turned_) {
    const auto drops = [this](const FacetPair& pair) {
      return corners_.drops(pair) || far_sides_.drops(pair);
    };
    edges_.join(pose_, k, own_tree_, way, drops, rows_);
  } else {
    averaged_.clear();
    std::ranges::remove_copy_if(pairs_, std::back_inserter(averaged_),
                                [this](const FacetPair& pair) { return corners_.drops(pair); });
    mortar_rows(k, n, averaged_, options_, buffers_, rows_);
  }
  if (corners_.count() > 0) corners_.join(rows_);
}

void SurfaceObstacle::join(std::span<const double> pose, std::span<const double> begin,
                           double travel, std::span<const double> reaction) {
  const double way = travel_ + travel;
  options_.reach = reach_ + way;
  if (!near_.holds(pose, options_.reach)) {
    find_near(pose, reaction, true);
    if (yields()) find_zone();
    place(time_);
  }
  give_way(reaction);
  const PosedSurface k = posed(own_, pose), n = posed(near_, pose_);
  refit(own_tree_, k, options_.reach);
  if (fitted_ != pose_) {  // walls stand
    refit(tree_, n, 0.0);
    fitted_ = pose_;
  }
  if (met_->law.points) return join_points(k, n);
  join_averages(k, begin, n, way);
}

void SurfaceObstacle::begin_slip(int i, std::span<const double> anchor) {
  slip_begin_.assign(anchor.begin(), anchor.end());
  if (!anchor.empty()) return;
  slip_begin_.resize(width());
  motion_->interpolate(motion_->u, i <= 1 ? grid_.begin : grid_.time(i - 1), slip_begin_);
}

void SurfaceObstacle::end_slip(std::span<const double> reaction, std::span<double> anchor) {
  motion_->interpolate(motion_->u, time_, anchor);
  give_way(reaction);
  // What was looked up as near beside these must not matter, not even by roundings: a run that goes
  // on from a checkpoint looks it up anew.
  for (std::size_t v = 0; yields() && v < zone_.size(); ++v)
    anchor[zone_[v]] = pose_[zone_near_[v]] - near_.points[zone_near_[v]];
}

void SurfaceObstacle::find_begin(std::vector<double>& places) const {
  places.resize(near_.points.size());
  motion_->interpolate(motion_->u, begin_, near_.values(), places);
  for (std::size_t v = 0; v < places.size(); ++v) places[v] += near_.points[v];
}

void SurfaceObstacle::add_compliance(Eigen::Index first, std::span<const double> directions,
                                     Eigen::MatrixXd& a) {
  if (!yields() || rows_.count() == 0) return;
  const std::size_t components = directions.size() / index(rows_.dim);
  std::vector<double> force(zone_.size(), 0.0);
  for (std::size_t r = 0; r < components; ++r) {
    answer_.assign(zone_.size(), 0.0);
    if (met_->kernel.band.empty()) {
      find_terms(directions, r, [this](std::size_t value, double part) {
        const double* moved = give_.data() + value * zone_.size();
        for (std::size_t v = 0; v < zone_.size(); ++v) answer_[v] += part * moved[v];
      });
    } else {
      std::ranges::fill(force, 0.0);
      find_terms(directions, r, [&](std::size_t value, double part) { force[value] += part; });
      add_moved(met_->kernel, give_, 1.0, force, answer_);
    }
    for (std::size_t s = 0; s < components; ++s)
      find_terms(directions, s, [&](std::size_t value, double part) {
        a(first + static_cast<Eigen::Index>(s), first + static_cast<Eigen::Index>(r)) +=
            part * answer_[value];
      });
  }
}

}  // namespace abut
