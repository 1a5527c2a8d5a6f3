#include "subdomain_solver/port_forces.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "base/count.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Of a substep: times nearer to its end than this are its end, rounded.
constexpr double force_rounding = 1.0e-6;

}  // namespace

void PortForces::join(std::size_t port, const std::vector<std::size_t>& massless) {
  joined_.push_back(port);
  light_.insert(light_.end(), massless.begin(), massless.end());
}

void PortForces::impose(const std::vector<BoundaryData>& boundary, const Substeps& grid,
                        std::span<const double> light_before) {
  grid_ = grid;
  light_before_.assign(light_before.begin(), light_before.end());
  light_before_.resize(light_.size(), 0.0);
  forces_.clear();
  swings_.clear();
  ends_.clear();
  for (std::size_t p = 0; p < std::min(boundary.size(), map_.ports()); ++p) {
    bool first = true;
    for (const Waveform& force : boundary[p].forces) {
      if (force.empty()) continue;
      if (joined(p)) {
        add_constant(force, p, first);
      } else {
        add_sampled(force, p, first);
      }
      first = false;
    }
  }
  // Means that end leave slopes behind.
  if (std::ranges::any_of(light_before_, [](double force) { return force != 0.0; }))
    forces_.resize(index(grid_.count + 1) * map_.values(), 0.0);
}

void PortForces::add_constant(const Waveform& imposed, std::size_t port, bool first) {
  forces_.resize(index(grid_.count + 1) * map_.values(), 0.0);
  mean_.resize(index(imposed.width));
  for (int i = 1; i <= grid_.count; ++i) {
    imposed.impulse(i == 1 ? grid_.begin : grid_.time(i - 1), grid_.time(i), mean_);
    for (double& f : mean_) f /= grid_.length(i);
    add(imposed, mean_.data(), first, forces_.data() + index(i) * map_.values() + map_.first(port));
  }
}

void PortForces::add_sampled(const Waveform& imposed, std::size_t port, bool first) {
  forces_.resize(index(grid_.count + 1) * map_.values(), 0.0);
  const std::size_t width = index(imposed.width), listed = imposed.points.size();
  ABUT_ASSERT(width == (listed == 0 ? map_.width(port) : listed * index(map_.dim())));
  const bool same = imposed.support != ForceSupport::step && grid_.matches(imposed.time);
  mean_.resize(width);
  for (int i = 0; i <= grid_.count; ++i) {
    double* row = forces_.data() + index(i) * map_.values() + map_.first(port);
    if (same) {  // the common case, and exact: no averaging at all
      add(imposed, imposed.f.data() + index(i) * width, first, row);
      continue;
    }
    const double now = i == 0 ? grid_.begin : grid_.time(i);
    const double before = i <= 1 ? grid_.begin : grid_.time(i - 1);
    const double after = i == grid_.count ? grid_.end : grid_.time(i + 1);
    const double from = 0.5 * (before + now), until = 0.5 * (now + after);
    if (until <= from) {  // a window of no length
      imposed.force_at(now, mean_);
    } else {
      imposed.impulse(from, until, mean_);
      for (double& f : mean_) f /= until - from;
    }
    add(imposed, mean_.data(), first, row);
    const std::size_t place = map_.first(port);
    if (keeps_swings_) {
      add_swing(imposed, now, index(i) * map_.values() + place, swings_, forces_.size());
    } else if (i == grid_.count && imposed.support == ForceSupport::linear) {
      add_swing(imposed, now, place, ends_, map_.values());
    }
  }
}

/// What lies at the port alone follows the instant (Waveform at its own times), the body the mean.
void PortForces::add_swing(const Waveform& imposed, double now, std::size_t row,
                           std::vector<double>& to, std::size_t size) {
  to.resize(size, 0.0);
  instant_.resize(mean_.size());
  imposed.force_at(now, instant_);
  for (std::size_t k = 0; k < mean_.size(); ++k) instant_[k] -= mean_[k];
  add(imposed, instant_.data(), false, to.data() + row);
}

bool PortForces::add_end(std::vector<double>& force) const {
  for (std::size_t k = 0; k < ends_.size(); ++k) force[k] += ends_[k];
  return !ends_.empty();
}

/// The values of the points that a waveform lists to those of all points of its port. The first
/// ones are taken as they are: zeros have signs.
void PortForces::add(const Waveform& imposed, const double* values, bool first, double* row) const {
  const std::size_t dim = index(map_.dim()), width = index(imposed.width);
  for (std::size_t k = 0; k < width; ++k) {
    const bool listed = !imposed.points.empty();
    double& sum = row[listed ? index(imposed.points[k / dim]) * dim + k % dim : k];
    sum = first ? values[k] : sum + values[k];
  }
}

void PortForces::light_means(int i, std::vector<double>& out) const {
  out.assign(light_.size(), 0.0);
  if (acts())
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = forces_[index(i) * map_.values() + light_[k]];
}

/// What has no mass would jump with forces that are constant in steps, and each jump would take
/// half of the change of the force, times that of the place, from the pair. With the slope of the
/// last two means it jumps by what the slope changes  [M.164].
void PortForces::add_slopes(double time, std::vector<double>& out) const {
  const int i = std::min(substep_, grid_.count);
  if (i == 0) return;
  const double begin = i == 1 ? grid_.begin : grid_.time(i - 1);
  const double share = std::clamp((time - begin) / grid_.length(i), 0.0, 1.0);
  for (std::size_t k = 0; k < light_.size(); ++k) {
    const double before =
        i == 1 ? light_before_[k] : forces_[index(i - 1) * map_.values() + light_[k]];
    double& force = out[light_[k]];  // the mean
    force += (share - 0.5) * (force - before);
  }
}

void PortForces::at(double time, std::vector<double>& out) const {
  out.assign(map_.values(), 0.0);
  if (forces_.empty()) return;
  const double place = grid_.count > 0 ? (time - grid_.begin) / grid_.step : 0.0;
  const int near = count_within(place, 0, grid_.count);
  const double length = std::max(grid_.step, 0.0);
  const auto row = [this](int i) { return forces_.data() + index(i) * map_.values(); };
  const auto instant = [this](int i) { return i == 0 ? grid_.begin : grid_.time(i); };
  if (grid_.count == 0 || std::abs(time - instant(near)) <= force_rounding * length) {
    std::copy_n(row(near), map_.values(), out.begin());
  } else {
    const int after = count_within(std::ceil(place), 1, grid_.count);
    const double share =
        std::clamp((time - instant(after - 1)) / (instant(after) - instant(after - 1)), 0.0, 1.0);
    for (std::size_t k = 0; k < map_.values(); ++k)
      out[k] = (1.0 - share) * row(after - 1)[k] + share * row(after)[k];
  }
  for (const std::size_t port : joined_)
    std::copy_n(row(std::min(substep_, grid_.count)) + map_.first(port), map_.width(port),
                out.begin() + static_cast<std::ptrdiff_t>(map_.first(port)));
  add_slopes(time, out);
}

void PortForces::add(double time, std::span<const double> q, Vector& force) const {
  if (forces_.empty()) return;
  at(time, now_);
  map_.lift(q, now_, force);
}

}  // namespace abut
