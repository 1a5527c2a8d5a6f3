#include "coordinator/coupling/port_pose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/assert.hpp"

namespace abut {

void PortPose::see(const PortGeometry& geometry, const Waveform& trace) {
  if (std::exchange(seen_, true)) return;
  const std::size_t width = geometry.points.size();
  ABUT_ASSERT(trace.points.empty() && trace.u.size() == trace.size() * width);
  geometry_ = &geometry;
  points_ = geometry.points;
  const std::size_t last = trace.u.size() - width;
  for (std::size_t k = 0; k < width; ++k) points_[k] += trace.u[last + k];
  if (tree_.empty())
    build(tree_, surface(), 0.0);
  else
    refit(tree_, surface(), 0.0);
  see_velocities(trace);
}

void PortPose::see_velocities(const Waveform& trace) {
  const auto dim = static_cast<Eigen::Index>(geometry_->dim);
  const auto count = static_cast<Eigen::Index>(trace.v.size()) / dim;
  velocity_.setZero();
  spread_ = 0.0;
  if (count == 0) return;
  const Eigen::Map<const Eigen::MatrixXd> v(trace.v.data(), dim, count);
  const Eigen::VectorXd middle = 0.5 * (v.rowwise().minCoeff() + v.rowwise().maxCoeff());
  velocity_.head(dim) = middle;
  spread_ = std::sqrt((v.colwise() - middle).colwise().squaredNorm().maxCoeff());
}

}  // namespace abut
