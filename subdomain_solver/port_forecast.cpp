#include "subdomain_solver/port_forecast.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace abut {

bool PortForecast::tell(const Window& window, std::vector<double>& u) {
  const auto presses = [](const BoundaryData& on) {
    return std::ranges::any_of(on.forces, [](const Waveform& force) {
      return std::ranges::any_of(force.f, [](double f) { return f != 0.0; });
    });
  };
  if (std::ranges::any_of(window.request.boundary, presses)) return false;
  const Substeps& grid = window.grid;
  forces_.impose(window.request.boundary, grid);
  forces_.enter(1);
  ahead_.steps = 0;
  u.resize(index(grid.count) * map_.values());
  for (int i = 1; i <= grid.count; ++i) {
    if (!steps_.foresee(motion_, grid.time(i - 1), grid.length(i), ahead_)) return false;
    map_.displacement(ahead_.q, places_);
    std::ranges::copy(places_, u.begin() + (i - 1) * static_cast<std::ptrdiff_t>(places_.size()));
  }
  return true;
}

}  // namespace abut
