#include "subdomain_solver/rigid/rigid_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/dense.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d at_node(std::span<const double> field, int node, int dim) {
  Vector3d out = Vector3d::Zero();
  for (int i = 0; i < dim; ++i) out(i) = field[node * dim + i];
  return out;
}

double largest_misfit(std::span<const double> a, std::span<const double> b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// The turn that takes arms r nearest to arms s, from the sum of m s r^T about their means.
Eigen::Quaterniond nearest_turn(const Matrix3d& sum, int dim) {
  if (dim == 1) return Eigen::Quaterniond::Identity();
  const Vector3d twist(sum(2, 1) - sum(1, 2), sum(0, 2) - sum(2, 0), sum(1, 0) - sum(0, 1));
  if (dim == 2) {  // no turn out of the plane
    return Eigen::Quaterniond(
        Eigen::AngleAxisd(std::atan2(twist(2), sum.trace()), Vector3d::UnitZ()));
  }
  Eigen::Matrix4d horn;
  horn << sum.trace(), twist.transpose(), twist,
      Matrix3d(sum + sum.transpose() - sum.trace() * Matrix3d::Identity());
  Eigen::Vector4d best = symmetric_eigen(horn).vectors.col(3);
  if (best(0) < 0.0) best = -best;
  return Eigen::Quaterniond(best(0), best(1), best(2), best(3)).normalized();
}

}  // namespace

PoseFit fit_pose(const RigidModel& body, const FeModel& mesh,
                 std::span<const double> displacement) {
  const int dim = body.dim(), nodes = mesh.mesh().node_count();
  double total = 0.0;
  Vector3d arm_mean = Vector3d::Zero(), mean = Vector3d::Zero();
  for (int node = 0; node < nodes; ++node) {
    const double m = mesh.lumped_mass()(node * dim);
    total += m;
    arm_mean += m * (at_node(mesh.mesh().points, node, dim) - body.centre());
    mean += m * at_node(displacement, node, dim);
  }
  arm_mean /= total;
  mean /= total;
  Matrix3d sum = Matrix3d::Zero();
  for (int node = 0; node < nodes; ++node) {
    const Vector3d arm = at_node(mesh.mesh().points, node, dim) - body.centre() - arm_mean;
    const Vector3d turned = arm + at_node(displacement, node, dim) - mean;
    sum += mesh.lumped_mass()(node * dim) * turned * arm.transpose();
  }
  PoseFit fit;
  fit.pose.attitude = nearest_turn(sum, dim);
  fit.pose.displacement = mean + arm_mean - fit.pose.attitude * arm_mean;
  std::vector<double> rigid(displacement.size());
  RigidMap(body, mesh.mesh()).displacement(body.coordinates(fit.pose), rigid);
  fit.distance = largest_misfit(rigid, displacement);
  return fit;
}

TwistFit fit_twist(const RigidModel& body, const FeModel& mesh, const SparseMatrix& mass,
                   const Pose& pose, std::span<const double> velocity) {
  const int dim = body.dim(), nodes = mesh.mesh().node_count();
  const Eigen::Map<const Vector> field(velocity.data(), static_cast<Eigen::Index>(velocity.size()));
  const Vector momentum = mass * field;
  Vector3d sum = Vector3d::Zero(), angular = Vector3d::Zero();
  for (int node = 0; node < nodes; ++node) {
    const Vector3d p = at_node(span_of(momentum), node, dim);
    const Vector3d arm = pose.attitude * (at_node(mesh.mesh().points, node, dim) - body.centre());
    sum += p;
    angular += arm.cross(p);
  }
  TwistFit fit;
  fit.twist.velocity = sum / body.total_mass();
  const std::vector<double> q = body.coordinates(pose);
  fit.twist.angular = body.angular_velocity(pose.attitude, angular);
  std::vector<double> rigid(velocity.size());
  RigidMap(body, mesh.mesh()).velocity(q, body.rates(pose, fit.twist), rigid);
  fit.distance = largest_misfit(rigid, velocity);
  return fit;
}

}  // namespace abut
