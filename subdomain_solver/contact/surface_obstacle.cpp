#include "subdomain_solver/contact/surface_obstacle.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/force_means.hpp"

namespace abut {

namespace {

PosedSurface posed(const PortGeometry& surface, std::span<const double> points) {
  return {surface.dim, points, surface.facets, surface.offsets};
}

/// [m] of the facets: what is farther from one than that is not what it presses on.
double longest_edge(const PortGeometry& surface) {
  const std::size_t dim = index(surface.dim);
  double longest = 0.0;
  for (std::size_t f = 0; f + 1 < surface.offsets.size(); ++f) {
    for (std::int32_t a = surface.offsets[f]; a + 1 < surface.offsets[f + 1]; ++a) {
      const std::size_t from = index(surface.facets[index(a)]),
                        to = index(surface.facets[index(a + 1)]);
      double square = 0.0;
      for (std::size_t i = 0; i < dim; ++i) {
        const double along = surface.points[to * dim + i] - surface.points[from * dim + i];
        square += along * along;
      }
      longest = std::max(longest, std::sqrt(square));
    }
  }
  return longest;
}

}  // namespace

SurfaceObstacle::SurfaceObstacle(std::size_t port, std::size_t partner, const PortGeometry& own,
                                 const Partner& met, std::string body)
    : port_(port), partner_(partner), own_(own), met_(&met), body_(std::move(body)) {
  reach_ = longest_edge(own);
  free_ = pose_ = met.surface.points;
  build(tree_, posed(met.surface, pose_), reach_);
  build(own_tree_, posed(own, own.points), 0.0);
}

void SurfaceObstacle::impose(const BoundaryData& data, const Partner& met, const Substeps& grid) {
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
  if (!yields()) return;
  const PortKernel& kernel = met_->kernel;
  if (index(kernel.count() + 1) < motion_->size() || index(kernel.width) != width() ||
      kernel.patterns != kernel.width || kernel.begin.size() != kernel.displacement.size()) {
    throw RunError("an obstacle that gives way has a kernel that is too short or of other points",
                   fmt::format("body '{}'", body_),
                   "Give its motion at its own substeps, with the kernel of as many.");
  }
  parts_ = force_means(motion_->time, levels_of(grid));
  taken_.assign(motion_->size() * width(), 0.0);
  if (motion_->f.empty()) return;
  for (std::size_t k = 0; k < taken_.size(); ++k) taken_[k] = -motion_->f[k];
}

/// [m/N] (values) of the surface at a level to a force at another one, 0: the window's begin.
const double* SurfaceObstacle::response(int level, int at, std::size_t force) const {
  const PortKernel& kernel = met_->kernel;
  const std::vector<double>& of = at == 0 ? kernel.begin : kernel.displacement;
  return of.data() + (index(at == 0 ? level - 1 : level - at) * width() + force) * width();
}

/// Earlier reactions are known, this substep's goes on being the later ones' guess [M.92].
void SurfaceObstacle::aim(int i, std::span<const double> reaction) {
  const std::size_t w = width(), levels = motion_->size(), columns = index(grid_.count + 1);
  memory_.assign(w, 0.0);
  find_travel(i);
  if (!yields() || i == 0) return;
  const std::size_t last = index(i - 1);
  for (std::size_t l = 0; l < levels; ++l) {
    const double part = parts_[l * columns + last];
    for (std::size_t v = 0; part != 0.0 && v < w; ++v) taken_[l * w + v] += part * reaction[v];
  }
  later_.assign(levels, 0.0);
  for (std::size_t l = 0; l < levels; ++l)
    for (std::size_t j = index(i); j < columns; ++j) later_[l] += parts_[l * columns + j];
  give_.assign(w * w, 0.0);
  const double time = grid_.time(i);
  const auto after = std::ranges::lower_bound(motion_->time, time) - motion_->time.begin();
  const int next =
      static_cast<int>(std::clamp<std::ptrdiff_t>(after, 1, std::ssize(motion_->time) - 1));
  const double before = motion_->time[index(next - 1)], end = motion_->time[index(next)];
  const double share = std::clamp((time - before) / (end - before), 0.0, 1.0);
  recall(next, share);
  find_give(next, share);
  if (share == 1.0) return;
  recall(next - 1, 1.0 - share);
  find_give(next - 1, 1.0 - share);
}

/// Adds a share of what earlier reactions have moved the surface at a level.
void SurfaceObstacle::recall(int level, double share) {
  const std::size_t w = width();
  for (int at = 0; at <= level && level > 0; ++at) {
    for (std::size_t f = 0; f < w; ++f) {
      const double force = share * taken_[index(at) * w + f];
      if (force == 0.0) continue;
      const double* answer = response(level, at, f);
      for (std::size_t v = 0; v < w; ++v) memory_[v] += force * answer[v];
    }
  }
}

/// Adds a share of what this substep's reaction moves the surface at a level.
void SurfaceObstacle::find_give(int level, double share) {
  const std::size_t w = width();
  for (int at = 0; at <= level && level > 0; ++at) {
    const double part = share * later_[index(at)];
    if (part == 0.0) continue;
    for (std::size_t f = 0; f < w; ++f) {
      const double* answer = response(level, at, f);
      for (std::size_t v = 0; v < w; ++v) give_[f * w + v] += part * answer[v];
    }
  }
}

void SurfaceObstacle::find_travel(int i) {
  travel_ = 0.0;
  if (i == 0) return;
  before_.resize(width());
  given_.resize(width());
  motion_->interpolate(motion_->u, i == 1 ? grid_.begin : grid_.time(i - 1), before_);
  motion_->interpolate(motion_->u, grid_.time(i), given_);
  for (std::size_t v = 0; v < width(); ++v)
    travel_ = std::max(travel_, std::abs(given_[v] - before_[v]));
}

void SurfaceObstacle::place(double time) {
  given_.resize(width());
  motion_->interpolate(motion_->u, time, given_);
  for (std::size_t v = 0; v < width(); ++v)
    free_[v] = met_->surface.points[v] + given_[v] + memory_[v];
}

void SurfaceObstacle::give_way(std::span<const double> reaction) {
  pose_ = free_;
  if (!yields()) return;
  for (std::size_t f = 0; f < width(); ++f) {
    if (reaction[f] == 0.0) continue;
    for (std::size_t v = 0; v < width(); ++v) pose_[v] += reaction[f] * compliance(v, f);
  }
}

void SurfaceObstacle::join(std::span<const double> pose, double travel) {
  options_.reach = reach_ + travel_ + travel;
  const PosedSurface k = posed(own_, pose), n = posed(met_->surface, pose_);
  refit(own_tree_, k, 0.0);
  refit(tree_, n, options_.reach);
  overlapping_pairs(own_tree_, tree_, pairs_);
  mortar_rows(k, n, pairs_, options_, buffers_, rows_);
}

void SurfaceObstacle::add_compliance(Eigen::Index first, Eigen::MatrixXd& a) {
  if (!yields()) return;
  const std::size_t dim = index(rows_.dim);
  const auto each = [this, dim](int row, const auto& visit) {
    for (std::int32_t e = rows_.n.offsets[index(row)]; e < rows_.n.offsets[index(row) + 1]; ++e) {
      for (std::size_t d = 0; d < dim; ++d)
        visit(index(rows_.n.columns[index(e)]) * dim + d,
              rows_.n.values[index(e)] * rows_.normals[index(row) * dim + d]);
    }
  };
  for (int r = 0; r < rows_.count(); ++r) {
    answer_.assign(width(), 0.0);
    each(r, [this](std::size_t force, double part) {
      for (std::size_t v = 0; v < width(); ++v) answer_[v] += part * compliance(v, force);
    });
    for (int s = 0; s < rows_.count(); ++s)
      each(s, [&](std::size_t value, double part) {
        a(first + s, first + r) += part * answer_[value];
      });
  }
}

}  // namespace abut
