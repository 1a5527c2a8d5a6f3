#include "subdomain_solver/bars/bar_midpoint.hpp"


namespace abut {

BarMidpoint::BarMidpoint(const Bar& bar) : bar_(bar), mass_(index(bar.nodes()), 0.0) {
  for (std::size_t e = 0; e + 1 < mass_.size(); ++e) {
    mass_[e] += 0.5 * bar.element_mass();
    mass_[e + 1] += 0.5 * bar.element_mass();
  }
}

double BarMidpoint::kinetic(const std::vector<double>& v) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i) sum += mass_[i] * v[i] * v[i];
  return 0.5 * sum;
}

double BarMidpoint::momentum(const std::vector<double>& v) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < mass_.size(); ++i) sum += mass_[i] * v[i];
  return sum;
}

bool BarMidpoint::held(std::size_t node) const {
  return (node == 0 && bar_.data().fixed[0]) || (node + 1 == mass_.size() && bar_.data().fixed[1]);
}

void BarMidpoint::factor(double length) {
  if (length == length_) return;
  length_ = length;
  std::vector<double> diagonal = mass_, beside(mass_.size() - 1, 0.0);
  const double quarter = 0.25 * length * length;
  for (std::size_t e = 0; e < beside.size(); ++e) {
    const double stiffness = quarter * bar_.stiffness()[e];
    diagonal[e] += stiffness;
    diagonal[e + 1] += stiffness;
    if (!held(e) && !held(e + 1)) beside[e] = -stiffness;
  }
  matrix_.factor(diagonal, beside);
  for (const int by : {0, 1}) {
    std::vector<double> column(mass_.size(), 0.0);
    if (!held(index(bar_.node_of(by)))) column[index(bar_.node_of(by))] = 0.5;
    matrix_.solve(column);
    columns_[index(by)] = {column.front(), column.back()};
  }
}

void BarMidpoint::step(double length, const std::vector<double>& force,
                       const std::array<double, 2>& impulse, std::vector<double>& u,
                       std::vector<double>& v) {
  factor(length);
  middle_ = u;
  for (std::size_t i = 0; i < u.size(); ++i) middle_[i] += 0.5 * length * v[i];
  bar_.internal_force(middle_, change_);
  for (std::size_t i = 0; i < u.size(); ++i) change_[i] = length * (force[i] - change_[i]);
  change_.front() += impulse[0];
  change_.back() += impulse[1];
  for (const std::size_t node : {std::size_t{0}, u.size() - 1})
    if (held(node)) change_[node] = 0.0;
  matrix_.solve(change_);
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] += length * (v[i] + 0.5 * change_[i]);
    v[i] += change_[i];
  }
}

}  // namespace abut
