#include "subdomain_solver/bars/bar_loads.hpp"

#include <utility>


namespace abut {

BarLoads::BarLoads(const Bar& bar, bool lumped) : own_(bar.row_mass()) {
  for (int node = 0; node < bar.nodes(); ++node) place_.push_back(bar.place_of(node));
  if (lumped) return;
  own_ = bar.mass();
  beside_ = bar.mass_beside();
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
