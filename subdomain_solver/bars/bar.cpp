#include "subdomain_solver/bars/bar.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

double BarProperties::wave_speed() const { return std::sqrt(youngs_modulus / density); }
double BarProperties::impedance() const { return density * wave_speed() * area; }
double BarProperties::mass_total() const { return density * area * length; }

Bar::Bar(const BarProperties& data)
    : data_(data),
      element_stiffness_(data.youngs_modulus * data.area / (data.length / data.elements)),
      element_mass_(data.density * data.area * (data.length / data.elements)) {
  stiffness_.assign(index(data_.elements), element_stiffness_);
  for (int end : {0, 1}) {
    if (data_.layer[end] == ContactLayer::massless) {
      stiffness_[end == 0 ? 0 : stiffness_.size() - 1] *= data_.stiffness_factor;
    }
  }
  build_mass();
}

void Bar::build_mass() {
  const std::size_t n = index(nodes());
  const double b = data_.mass == MassForm::averaged     ? 1.0 / 12.0
                   : data_.mass == MassForm::consistent ? 1.0 / 6.0
                                                        : 0.0;
  mass_.assign(n, 0.0);
  row_mass_.assign(n, 0.0);
  mass_beside_.assign(n - 1, 0.0);
  const bool massless_left = data_.layer[0] == ContactLayer::massless;
  const bool massless_right = data_.layer[1] == ContactLayer::massless;
  for (std::size_t e = 0; e + 1 < n; ++e) {
    const bool left = massless_left && e == 0;
    const bool right = massless_right && e + 2 == n;
    if (left || right) {  // the whole element goes to its inner node
      const std::size_t inner = left ? 1 : n - 2;
      mass_[inner] += element_mass_;
      row_mass_[inner] += element_mass_;
      continue;
    }
    mass_[e] += (0.5 - b) * element_mass_;
    mass_[e + 1] += (0.5 - b) * element_mass_;
    mass_beside_[e] += b * element_mass_;
    row_mass_[e] += 0.5 * element_mass_;
    row_mass_[e + 1] += 0.5 * element_mass_;
  }
  inverse_mass_.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool held = (i == 0 && data_.fixed[0]) || (i + 1 == n && data_.fixed[1]);
    if (row_mass_[i] > 0.0 && !held) inverse_mass_[i] = 1.0 / row_mass_[i];
  }
}

double Bar::stable_step() const {
  double omega_squared = 0.0;
  const std::size_t n = index(nodes());
  for (std::size_t i = 0; i < n; ++i) {
    const double left = i > 0 ? stiffness_[i - 1] : 0.0;
    const double right = i + 1 < n ? stiffness_[i] : 0.0;
    omega_squared = std::max(omega_squared, 2.0 * (left + right) * inverse_mass_[i]);
  }
  // viscous forces use the velocity of the last half step, which costs a part of the limit
  const double b = data_.bulk_viscosity;
  // determinant 1 - (phi - 1) z and trace 2 - phi z of a step, z = (omega dt)^2: the root -1
  const double forward = std::sqrt(2.0 * data_.tchamwa - 1.0);
  return 2.0 / std::sqrt(omega_squared) * (std::sqrt(1.0 + b * b) - b) / forward;
}

void Bar::internal_force(std::span<const double> x, std::vector<double>& out) const {
  const std::size_t n = index(nodes());
  out.resize(n);
  double from_left = 0.0;  // tension of the element to the left
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double tension = stiffness_[i] * (x[i + 1] - x[i]);
    out[i] = from_left - tension;
    from_left = tension;
  }
  out[n - 1] = from_left;
}

double Bar::kinetic(const std::vector<double>& v) const {
  double sum = 0.0;
  const std::size_t n = index(nodes());
  for (std::size_t i = 0; i < n; ++i) sum += mass_[i] * v[i] * v[i];
  if (!lumped()) {
    for (std::size_t e = 0; e + 1 < n; ++e) sum += 2.0 * mass_beside_[e] * v[e] * v[e + 1];
  }
  return 0.5 * sum;
}

double Bar::stored(const std::vector<double>& x) const {
  double sum = 0.0;
  for (std::size_t e = 0; e < stiffness_.size(); ++e) {
    const double stretch = x[e + 1] - x[e];
    sum += stiffness_[e] * stretch * stretch;
  }
  return 0.5 * sum;
}

double Bar::momentum(const std::vector<double>& v) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += row_mass_[i] * v[i];
  return sum;
}

}  // namespace abut
