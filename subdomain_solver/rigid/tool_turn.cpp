#include "subdomain_solver/rigid/tool_turn.hpp"

#include <cmath>
#include <utility>

namespace abut {

ToolTurn::ToolTurn(Angle angle, Eigen::Vector3d about, const Eigen::Vector3d& axis)
    : angle_(std::move(angle)), about_(std::move(about)), axis_(axis.stableNormalized()) {
  across_ << 0.0, -axis_(2), axis_(1), axis_(2), 0.0, -axis_(0), -axis_(1), axis_(0), 0.0;
}

/// R = 1 + sin K + (1 - cos) K K (Rodrigues), differences of sines and cosines as products.
Eigen::Matrix3d ToolTurn::between(double from, double to) const {
  const double middle = 0.5 * (from + to), way = 2.0 * std::sin(0.5 * (to - from));
  return way * std::cos(middle) * across_ + way * std::sin(middle) * (across_ * across_);
}

}  // namespace abut
