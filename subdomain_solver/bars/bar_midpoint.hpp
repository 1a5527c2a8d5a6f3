#pragma once

#include <array>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/bars/bar.hpp"
#include "subdomain_solver/solve/tridiagonal.hpp"

namespace abut {

/// The midpoint rule of a bar with all mass on its nodes, under impulses on its ends [M.128]: one
/// tridiagonal solve a step, factored once per length of step.
class BarMidpoint {
 public:
  explicit BarMidpoint(const Bar& bar);

  const std::vector<double>& mass() const { return mass_; }  // [kg] (nodes)
  double kinetic(const std::vector<double>& v) const;        // [J]
  double momentum(const std::vector<double>& v) const;       // [kg m/s]

  /// From displacements u [m] and velocities v [m/s] (nodes) over `length` [s], under mean forces
  /// on the nodes [N] and impulses on the ends [N s], along x.
  void step(double length, const std::vector<double>& force, const std::array<double, 2>& impulse,
            std::vector<double>& u, std::vector<double>& v);
  /// [1/kg] what an impulse on one end adds to the mean velocity of an end, in a step of the last
  /// length [M.129]; 0 of an end that is held.
  double compliance(int of, int by) const { return columns_[by][index(of)]; }

 private:
  void factor(double length);
  bool held(std::size_t node) const;

  const Bar& bar_;
  std::vector<double> mass_;
  double length_ = 0.0;  // [s] that is factored
  TriDiagonal matrix_;   // M + length^2 / 4 K
  std::array<std::array<double, 2>, 2> columns_{};
  std::vector<double> change_, middle_;  // [m/s], [m] scratch
};

}  // namespace abut
