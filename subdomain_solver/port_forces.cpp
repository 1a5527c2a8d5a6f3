#include "subdomain_solver/port_forces.hpp"

#include <algorithm>
#include <cmath>

#include "base/count.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Of a substep: times nearer to its end than this are its end, rounded.
constexpr double rounding = 1.0e-6;

}  // namespace

void PortForces::impose(const std::vector<BoundaryData>& boundary, const Substeps& grid) {
  grid_ = grid;
  forces_.clear();
  for (std::size_t p = 0; p < std::min(boundary.size(), map_.ports()); ++p) {
    if (!boundary[p].force.empty()) sample(boundary[p].force, p);
  }
}

void PortForces::impose(std::vector<double> at_begin, std::vector<double> in_first,
                        const Substeps& grid) {
  grid_ = grid;
  forces_ = std::move(at_begin);
  forces_.insert(forces_.end(), in_first.begin(), in_first.end());
  forces_.resize(index(grid.count + 1) * map_.values(), 0.0);
}

void PortForces::sample(const Waveform& imposed, std::size_t port) {
  forces_.resize(index(grid_.count + 1) * map_.values(), 0.0);
  const std::size_t width = index(imposed.width);
  const bool same = imposed.support == ForceSupport::nodal && grid_.matches(imposed.time);
  for (int i = 0; i <= grid_.count; ++i) {
    const std::span<double> to =
        std::span(forces_).subspan(index(i) * map_.values() + map_.first(port), width);
    if (same) {  // the common case, and exact: no averaging at all
      std::copy_n(imposed.f.begin() + static_cast<std::ptrdiff_t>(index(i) * width), width,
                  to.begin());
      continue;
    }
    const double now = i == 0 ? grid_.begin : grid_.time(i);
    const double before = i <= 1 ? grid_.begin : grid_.time(i - 1);
    const double after = i == grid_.count ? grid_.end : grid_.time(i + 1);
    const double from = 0.5 * (before + now), until = 0.5 * (now + after);
    if (until <= from) {  // a window of no length
      imposed.force_at(now, to);
      continue;
    }
    imposed.impulse(from, until, to);
    for (double& f : to) f /= until - from;
  }
}

std::vector<double> PortForces::at(double time) const {
  std::vector<double> out(map_.values(), 0.0);
  if (forces_.empty()) return out;
  const double place = grid_.count > 0 ? (time - grid_.begin) / grid_.step : 0.0;
  const int near = count_within(place, 0, grid_.count);
  const double length = std::max(grid_.step, 0.0);
  const auto row = [this](int i) { return forces_.data() + index(i) * map_.values(); };
  const auto instant = [this](int i) { return i == 0 ? grid_.begin : grid_.time(i); };
  if (grid_.count == 0 || std::abs(time - instant(near)) <= rounding * length) {
    std::copy_n(row(near), map_.values(), out.begin());
    return out;
  }
  const int after = count_within(std::ceil(place), 1, grid_.count);
  const double share =
      std::clamp((time - instant(after - 1)) / (instant(after) - instant(after - 1)), 0.0, 1.0);
  for (std::size_t k = 0; k < map_.values(); ++k)
    out[k] = (1.0 - share) * row(after - 1)[k] + share * row(after)[k];
  return out;
}

void PortForces::add(double time, std::span<const double> q, Vector& force) const {
  if (!forces_.empty()) map_.lift(q, at(time), force);
}

}  // namespace abut
