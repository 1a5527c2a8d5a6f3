#include "subdomain_solver/contact/point_obstacle.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/kernel.hpp"

namespace abut {

void PointObstacle::impose(const BoundaryData& data, const std::deque<Partner>& met,
                           const Substeps& grid) {
  partner_ = nullptr;
  grid_ = grid;
  for (std::size_t k = 0; k < data.obstacles.size(); ++k) {
    if (data.obstacles[k].empty()) continue;
    if (acts() || data.pushed() || k >= met.size()) {
      throw RunError("an end of a bar takes one obstacle at a time, of a partner that it has met",
                     fmt::format("body '{}'", body_), "Give one of the partners the other role.");
    }
    partner_ = &met[k];
    motion_ = &data.obstacles[k].motion;
    same_times_ = grid.matches(motion_->time);
  }
}

PointObstacle::Surface PointObstacle::where(double u) const {
  const double n = outward_, apart = n * (partner_->surface.points[0] - place_);
  const bool tied = partner_->law.tied;
  return {n * ((tied ? 0.0 : std::max(0.0, apart)) * n + u), 0.0, tied};
}

PointObstacle::Surface PointObstacle::between(double time) const {
  double u = 0.0;
  motion_->interpolate(motion_->u, time, {&u, 1});
  return where(u);
}

PointObstacle::Surface PointObstacle::at(int i, double reaction) {
  Surface surface =
      same_times_ ? where(motion_->u[i]) : between(i == 0 ? grid_.begin : grid_.time(i));
  if (yields()) give_way(i, reaction, surface);
  return surface;
}

/// What the surface has given way by the reactions so far, and how much it does per newton of this
/// substep's [M.82], [M.83].
void PointObstacle::give_way(int i, double reaction, Surface& surface) {
  const PortKernel& kernel = partner_->kernel;
  const std::vector<double>& under = motion_->f;
  if (!same_times_ || under.size() != motion_->size() ||
      kernel.count() + 1 < static_cast<int>(under.size())) {
    throw RunError(
        "an obstacle that gives way has other times than the body's substeps, no force, "
        "or a kernel that is too short",
        fmt::format("body '{}'", body_), "Give its motion and its force at every substep.");
  }
  const std::size_t now = index(i);
  excess_.resize(under.size());
  if (i != 1) excess_[now > 0 ? now - 1 : 0] = reaction - under[now > 0 ? now - 1 : 0];
  if (i == 0) return;  // that of the begin is known
  double moved = 0.0;
  const auto add = [&kernel, &moved](int lag, bool at_begin, double sign, const double& force) {
    add_response(kernel, lag, at_begin, sign, {&force, 1}, {&moved, 1});
  };
  add(0, false, -1.0, under[now]);
  if (!kernel.begin.empty()) add(i - 1, true, 1.0, excess_[0]);
  for (int j = 1; j < i; ++j) add(i - j, false, 1.0, excess_[j]);
  surface.target += outward_ * moved;
  surface.give = kernel.displacement[0];
}

}  // namespace abut
