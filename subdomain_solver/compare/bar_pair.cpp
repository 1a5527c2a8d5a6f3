#include "subdomain_solver/compare/bar_pair.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

BarPair::BarPair(const BarProperties& left, const BarProperties& right, ElementLengths lengths)
    : bars_{Bar(left), Bar(right)},
      lengths_(lengths),
      split_(index(bars_[0].nodes())),
      reference_gap_(right.position - (left.position + left.length)) {
  const std::size_t n = split_ + index(bars_[1].nodes());
  mass_.assign(n, 0.0);
  mass_beside_.assign(n - 1, 0.0);
  stiffness_.assign(n - 1, 0.0);
  element_mass_.assign(n - 1, 0.0);
  tension_.assign(n - 1, 0.0);
  for (int m : {0, 1}) {
    for (std::size_t e = first(m); e < last(m); ++e) {
      stiffness_[e] = bar(m).element_stiffness();
      element_mass_[e] = bar(m).element_mass();
    }
  }
  assemble_mass();
}

void BarPair::assemble_mass() {
  std::fill(mass_.begin(), mass_.end(), 0.0);
  for (int m : {0, 1}) {
    const MassForm form = bar(m).data().mass;
    const double b = form == MassForm::averaged     ? 1.0 / 12.0
                     : form == MassForm::consistent ? 1.0 / 6.0
                                                    : 0.0;
    for (std::size_t e = first(m); e < last(m); ++e) {
      mass_[e] += (0.5 - b) * element_mass_[e];
      mass_[e + 1] += (0.5 - b) * element_mass_[e];
      mass_beside_[e] = b * element_mass_[e];
    }
  }
}

bool BarPair::follow(const std::vector<double>& u) {
  if (lengths_ == ElementLengths::reference) return true;
  for (int m : {0, 1}) {
    const BarProperties& data = bar(m).data();
    for (std::size_t e = first(m); e < last(m); ++e) {
      const double length = bar(m).spacing() + (u[e + 1] - u[e]);
      if (!(length > 0.0)) return false;
      stiffness_[e] = data.youngs_modulus * data.area / length;
      element_mass_[e] = data.density * data.area * length;
      tension_[e] = data.youngs_modulus * data.area * std::log(length / bar(m).spacing());
    }
  }
  assemble_mass();
  return true;
}

double BarPair::stress(int member, std::size_t element, const std::vector<double>& u) const {
  const double strain = (u[element + 1] - u[element]) / bar(member).spacing();
  const double modulus = bar(member).data().youngs_modulus;
  return modulus * (lengths_ == ElementLengths::current ? std::log1p(strain) : strain);
}

double BarPair::stable_step(double contact_stiffness) const {
  double omega_squared = 0.0;
  for (std::size_t i = 0; i < nodes(); ++i) {
    double stiffness = (i > 0 ? stiffness_[i - 1] : 0.0) + (i + 1 < nodes() ? stiffness_[i] : 0.0);
    if (i == tip(0) || i == tip(1)) stiffness += contact_stiffness;
    omega_squared = std::max(omega_squared, 2.0 * stiffness / mass_[i]);
  }
  return 2.0 / std::sqrt(omega_squared);
}

void BarPair::internal_force(const std::vector<double>& u, std::vector<double>& out) const {
  out.resize(nodes());
  double from_left = 0.0;  // tension of the element to the left
  for (std::size_t e = 0; e < stiffness_.size(); ++e) {
    const double to_right = tension(e, u);
    out[e] = from_left - to_right;
    from_left = to_right;
  }
  out.back() = from_left;
}

void BarPair::apply_mass(const std::vector<double>& x, std::vector<double>& out) const {
  out.resize(nodes());
  for (std::size_t i = 0; i < nodes(); ++i) out[i] = mass_[i] * x[i];
  for (std::size_t e = 0; e < mass_beside_.size(); ++e) {
    out[e] += mass_beside_[e] * x[e + 1];
    out[e + 1] += mass_beside_[e] * x[e];
  }
}

double BarPair::mass_norm(int member, const std::vector<double>& x) const {
  double sum = 0.0;
  for (std::size_t i = first(member); i <= last(member); ++i) sum += mass_[i] * x[i] * x[i];
  for (std::size_t e = first(member); e < last(member); ++e)
    sum += 2.0 * mass_beside_[e] * x[e] * x[e + 1];
  return sum;
}

double BarPair::stored(int member, const std::vector<double>& u) const {
  double sum = 0.0;
  for (std::size_t e = first(member); e < last(member); ++e) {
    const double force = tension(e, u);
    sum += force * force / stiffness_[e];
  }
  return 0.5 * sum;
}

double BarPair::momentum(int member, const std::vector<double>& v) const {
  double sum = 0.0;
  for (std::size_t e = first(member); e < last(member); ++e)
    sum += 0.5 * element_mass_[e] * (v[e] + v[e + 1]);
  return sum;
}

}  // namespace abut
