#pragma once

#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// What may press on some coordinates of a body at the end of a step. Every scheme is affine in
/// such forces, x = free + compliance * force (the port line, [M.86]); who owns the geometry solves
/// for them.
class Contact {
 public:
  virtual ~Contact() = default;
  /// The coordinates that may be pressed, ascending.
  virtual const std::vector<int>& coordinates() const = 0;
  /// The forces [N] (coordinates) at a time, where the coordinates [m] would lie at `free` without
  /// them and give way by `compliance` [m/N]; good until the next call.
  virtual const Vector& solve(double time, const Vector& free,
                              const Eigen::MatrixXd& compliance) = 0;
};

}  // namespace abut
