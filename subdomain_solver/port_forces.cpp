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

/// How much of a line's begin is not where the one before has ended, of sides that step alike
/// [M.166]: what alternates from step to step is gone after a hundred.
constexpr double forgotten = 0.01;

/// [N] A force that is a line in each of some steps, on one value.
struct Line {
  double mean = 0.0, end = 0.0;
  /// Returns how much the force rises in the step that has this mean.
  double go_on(double next, double forgets) {
    double rise = next - mean;  // from half the way between both means
    if (forgets < 1.0) rise = 2.0 * (next - std::lerp(end, 0.5 * (mean + next), forgets));
    mean = next;
    end = next + 0.5 * rise;
    return rise;
  }
};

}  // namespace

void PortForces::join(std::size_t port, const std::vector<std::size_t>& massless, bool alike) {
  joined_.push_back(port);
  forgets_.resize(forgets_.size() + massless.size(), alike ? forgotten : 1.0);
  light_.insert(light_.end(), massless.begin(), massless.end());
}

void PortForces::impose(const std::vector<BoundaryData>& boundary, const Substeps& grid,
                        const Left& before) {
  grid_ = grid;
  before_ = before;
  before_.mean.resize(light_.size(), 0.0);
  before_.end.resize(light_.size(), 0.0);
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
  const auto acts = [](double force) { return force != 0.0; };
  if (std::ranges::any_of(before_.mean, acts) || std::ranges::any_of(before_.end, acts))
    forces_.resize(index(grid_.count + 1) * map_.values(), 0.0);
  lay_slopes(boundary);
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

void PortForces::leave(int i, Left& out) const {
  out.mean.assign(light_.size(), 0.0);
  out.end.assign(light_.size(), 0.0);
  if (!acts()) return;
  for (std::size_t k = 0; k < light_.size(); ++k) {
    const std::size_t here = index(i) * light_.size() + k;
    out.mean[k] = forces_[index(i) * map_.values() + light_[k]];
    if (forgets_[k] < 1.0) out.end[k] = out.mean[k] + levels_[here] + 0.5 * rises_[here];
  }
}

/// What has no mass would jump with forces that are constant in steps, and each jump would take
/// half of the change of the force, times that of the place, from the pair. With the slope of the
/// last two means it jumps by what the slope changes  [M.164].
void PortForces::lay_slopes(const std::vector<BoundaryData>& boundary) {
  rises_.clear();
  levels_.clear();
  if (light_.empty() || !acts()) return;
  rises_.resize(index(grid_.count + 1) * light_.size(), 0.0);
  levels_.resize(rises_.size(), 0.0);
  follow_own_steps();
  for (const std::size_t port : joined_)
    if (port < boundary.size()) follow_steps_of(boundary[port].forces, port);
}

void PortForces::follow_own_steps() {
  for (std::size_t k = 0; k < light_.size(); ++k) {
    Line line{before_.mean[k], before_.end[k]};
    for (int i = 1; i <= grid_.count; ++i)
      rises_[index(i) * light_.size() + k] =
          line.go_on(forces_[index(i) * map_.values() + light_[k]], forgets_[k]);
  }
}

/// A partner of longer steps has forces that are constant in those: lines in its steps, not in the
/// body's own, do not jump. Where several partners act on one port, those in the body's stay.
void PortForces::follow_steps_of(const std::vector<Waveform>& imposed, std::size_t port) {
  const Waveform* only = nullptr;
  for (const Waveform& force : imposed) {
    if (force.empty()) continue;
    if (only != nullptr) return;
    only = &force;
  }
  if (only == nullptr || only->support != ForceSupport::step || !only->points.empty() ||
      only->size() < 2 || only->size() > index(grid_.count))
    return;
  const std::size_t first = map_.first(port), width = map_.width(port);
  for (std::size_t k = 0; k < light_.size(); ++k) {
    if (light_[k] < first || light_[k] >= first + width) continue;
    Line line{before_.mean[k], before_.end[k]};
    slopes_.assign(only->size(), 0.0);
    for (std::size_t s = 1; s < only->size(); ++s)
      slopes_[s] = line.go_on(only->f[s * width + light_[k] - first], forgets_[k]) /
                   (only->time[s] - only->time[s - 1]);
    for (int i = 1; i <= grid_.count; ++i) {
      const double begin = i == 1 ? grid_.begin : grid_.time(i - 1), end = grid_.time(i);
      double rise = 0.0, level = 0.0;
      for (std::size_t s = 1; s < only->size(); ++s) {
        const double from = only->time[s - 1], until = only->time[s];
        const double shared_from = std::max(from, begin), shared_until = std::min(until, end);
        if (shared_until <= shared_from) continue;
        rise += slopes_[s] * (shared_until - shared_from);
        level += slopes_[s] * 0.5 * (shared_from + shared_until - from - until) *
                 (shared_until - shared_from) / (end - begin);
      }
      rises_[index(i) * light_.size() + k] = rise;
      levels_[index(i) * light_.size() + k] = level;
    }
  }
}

void PortForces::add_slopes(double time, std::vector<double>& out) const {
  const int i = std::min(substep_, grid_.count);
  if (i == 0 || rises_.empty()) return;
  const double begin = i == 1 ? grid_.begin : grid_.time(i - 1);
  const double share = std::clamp((time - begin) / grid_.length(i), 0.0, 1.0);
  for (std::size_t k = 0; k < light_.size(); ++k) {
    const std::size_t here = index(i) * light_.size() + k;
    out[light_[k]] += levels_[here] + (share - 0.5) * rises_[here];  // to the mean
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
