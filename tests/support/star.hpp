#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace abut {

/// A mass in space with points on springs around it, in closed form: without force it flies, and a
/// step of the midpoint rule under impulses eliminates the points one by one, since they hang on
/// the centre alone [M.128, M.129].
struct Star {
  std::vector<double> masses = {0.2, 0.3, 0.5};  // [kg] of the points
  double centre = 1.5;                           // [kg]
  double stiffness = 40.0;                       // [N/m] of each spring
  std::array<double, 3> gravity = {0.0, 0.0, -9.81};
  std::vector<double> u, v;  // [m] [m/s] of the points, then of the centre
  double work = 0.0;         // [J] of gravity

  explicit Star(const std::array<double, 3>& velocity) {
    u.assign(3 * (points() + 1), 0.0);
    for (std::size_t p = 0; p <= points(); ++p) v.insert(v.end(), velocity.begin(), velocity.end());
  }

  std::size_t points() const { return masses.size(); }
  double mass(std::size_t p) const { return p < points() ? masses[p] : centre; }
  double mass() const {
    double sum = centre;
    for (const double one : masses) sum += one;
    return sum;
  }
  std::array<double, 3> mean_velocity() const {
    std::array<double, 3> mean{};
    for (std::size_t k = 0; k < v.size(); ++k) mean[k % 3] += mass(k / 3) * v[k] / mass();
    return mean;
  }
  /// [m] by which a spring is longer along an axis.
  double pull(std::size_t k) const { return u[k] - u[3 * points() + k % 3]; }
  double kinetic() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < v.size(); ++k) sum += 0.5 * mass(k / 3) * v[k] * v[k];
    return sum;
  }
  double stored() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3 * points(); ++k) sum += 0.5 * stiffness * pull(k) * pull(k);
    return sum;
  }
  double energy() const { return kinetic() + stored(); }  // [J]

  /// Where all move alike.
  void fly(double step) {
    for (std::size_t k = 0; k < v.size(); ++k) {
      take(k, step, v[k] + 0.5 * step * gravity[k % 3]);
    }
  }
  /// Points go where their springs pull nothing, and all move alike.
  void settle() {
    const std::array<double, 3> mean = mean_velocity();
    for (std::size_t k = 0; k < v.size(); ++k) {
      v[k] = mean[k % 3];
      u[k] = u[3 * points() + k % 3];
    }
  }
  /// Impulses [N s] of all points.
  void step(double length, const std::vector<double>& impulses) {
    const double half = 0.5 * length, q = quarter(length);
    std::vector<double> known(points());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t c = 3 * points() + axis;
      const double g = half * gravity[axis];
      double sum = centre * (v[c] + g);
      for (std::size_t p = 0; p < points(); ++p) {
        const std::size_t k = 3 * p + axis;
        const double spring = half * stiffness * pull(k);
        known[p] = mass(p) * (v[k] + g) - spring + 0.5 * impulses[k];
        sum += spring + share(p, q) * known[p];
      }
      const double w = sum / left_over(q);
      take(c, length, w);
      for (std::size_t p = 0; p < points(); ++p)
        take(3 * p + axis, length, (known[p] + q * w) / (mass(p) + q));
    }
  }
  /// [1/kg] of two points along an axis, in a step of this length.
  double compliance(std::size_t p, std::size_t by, double length) const {
    const double q = quarter(length);
    const double own = p == by ? 1.0 / (mass(p) + q) : 0.0;
    return 0.5 * (own + share(p, q) * share(by, q) / left_over(q));
  }
  /// Of the kinetic energy that is not of all together. It knows no rotation.
  double damp(double joules) {
    const std::array<double, 3> mean = mean_velocity();
    double own = kinetic();
    for (const double one : mean) own -= 0.5 * mass() * one * one;
    const double taken = std::min(joules, std::max(own, 0.0));
    const double kept = own > 0.0 ? std::sqrt((own - taken) / own) : 0.0;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = mean[k % 3] + kept * (v[k] - mean[k % 3]);
    return taken;
  }

 private:
  double quarter(double length) const { return 0.25 * length * length * stiffness; }
  /// Of a point what it passes on to the centre.
  double share(std::size_t p, double q) const { return q / (mass(p) + q); }
  /// What stands before the centre's velocity once the points are eliminated.
  double left_over(double q) const {
    double rest = centre;
    for (std::size_t p = 0; p < points(); ++p) rest += q - q * share(p, q);
    return rest;
  }
  /// A step at this mean velocity.
  void take(std::size_t k, double length, double w) {
    u[k] += length * w;
    v[k] = 2.0 * w - v[k];
    work += mass(k / 3) * gravity[k % 3] * length * w;
  }
};

}  // namespace abut
