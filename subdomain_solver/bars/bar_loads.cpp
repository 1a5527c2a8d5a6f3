#include "subdomain_solver/bars/bar_loads.hpp"

#include <utility>

#include "base/index.hpp"

namespace abut {

BarLoads::BarLoads(const Bar& bar, bool lumped) : own_(bar.row_mass()) {
  const std::size_t n = index(bar.nodes());
  for (int node = 0; node < bar.nodes(); ++node) place_.push_back(bar.place_of(node));
  if (lumped) return;
  beside_.assign(n - 1, 0.0);
  own_.assign(n, 0.0);
  const double sixth = bar.element_mass() / 6.0;
  for (std::size_t e = 0; e + 1 < n; ++e) {
    const bool left = e == 0 && bar.data().layer[0] == ContactLayer::massless;
    const bool right = e + 2 == n && bar.data().layer[1] == ContactLayer::massless;
    if (left || right) {
      own_[left ? 1 : n - 2] += bar.element_mass();
      continue;
    }
    own_[e] += 2.0 * sixth;
    own_[e + 1] += 2.0 * sixth;
    beside_[e] = sixth;
  }
}

void BarLoads::push(int end, OfTime force) {
  pushes_.push_back({end == 0 ? 0 : place_.size() - 1, std::move(force)});
}

void BarLoads::accelerate(OfPlaceAndTime acceleration) {
  accelerations_.push_back(std::move(acceleration));
}

void BarLoads::at(double time, std::vector<double>& force) const {
  const std::size_t n = place_.size();
  force.assign(n, 0.0);
  if (!accelerations_.empty()) {
    acceleration_.assign(n, 0.0);
    for (const OfPlaceAndTime& of : accelerations_) {
      for (std::size_t i = 0; i < n; ++i) acceleration_[i] += of(place_[i], time);
    }
    for (std::size_t i = 0; i < n; ++i) force[i] = own_[i] * acceleration_[i];
    for (std::size_t e = 0; e < beside_.size(); ++e) {
      force[e] += beside_[e] * acceleration_[e + 1];
      force[e + 1] += beside_[e] * acceleration_[e];
    }
  }
  for (const Push& push : pushes_) force[push.node] += push.force(time);
}

}  // namespace abut
