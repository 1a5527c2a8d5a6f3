#include "subdomain_solver/contact/interference.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/index.hpp"
#include "surface/start_rows.hpp"

namespace abut {

namespace {

double deepest(const SurfaceRows& rows) {
  const auto least = std::ranges::min_element(rows.gaps);
  return least == rows.gaps.end() ? 0.0 : std::max(0.0, -*least);
}

StartSurface start_of(const PortGeometry& surface) { return {posed(surface), surface.spacing}; }

}  // namespace

/// No row of contact, whichever side's nodes it is of, begins closed.
void Interference::meet(const PortGeometry& own, const PortGeometry& other, bool points) {
  if (over_ == 0.0) return drawn_.push_back(0.0);
  const StartSurface k = start_of(own), n = start_of(other);
  double drawn = std::max(deepest(node_rows(k, n)), deepest(node_rows(n, k)));
  if (!points) drawn = std::max({drawn, deepest(average_rows(k, n)), deepest(average_rows(n, k))});
  drawn_.push_back(drawn);
}

void Interference::begin(double time) {
  if (state_.begun == 0.0) state_.begin = time;
  state_.begun = 1.0;
  for (std::size_t k = state_.left.size(); k < drawn_.size(); ++k)
    state_.left.push_back(left(k, time));
  state_.force.resize(drawn_.size(), 0.0);
  state_.work.resize(drawn_.size(), 0.0);
}

/// Without a jump of speed at either end.
double Interference::left(std::size_t partner, double time) const {
  if (over_ == 0.0) return 0.0;
  const double s = std::clamp((time - state_.begin) / over_, 0.0, 1.0);
  return drawn_[partner] * (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
}

/// By the mean of the forces at both ends, as the schemes work with them.
void Interference::settle(std::size_t partner, double time, double force) {
  const double now = left(partner, time);
  state_.work[partner] += 0.5 * (state_.force[partner] + force) * (state_.left[partner] - now);
  state_.left[partner] = now;
  state_.force[partner] = force;
}

void Interference::end() {
  state_.begun = 1.0;
  state_.begin = -std::numeric_limits<double>::infinity();
  std::ranges::fill(state_.left, 0.0);
  std::ranges::fill(state_.force, 0.0);
}

double Interference::work() const {
  return std::accumulate(state_.work.begin(), state_.work.end(), 0.0);
}

void Interference::state(Archive& archive) {
  archive.field("interference_begun", state_.begun);
  archive.field("interference_begin", state_.begin);
  archive.field("interference_left", state_.left);
  archive.field("interference_force", state_.force);
  archive.field("interference_work", state_.work);
}

}  // namespace abut
