#include "subdomain_solver/rigid/rigid_map.hpp"
#include "base/index.hpp"

namespace abut {

RigidMap::RigidMap(const RigidModel& body, const Mesh& mesh) : body_(body) {
  const std::size_t dim = index(mesh.dim);
  for (std::size_t k = 0; k < mesh.points.size(); k += dim) {
    Eigen::Vector3d arm = -body.centre();
    for (std::size_t i = 0; i < dim; ++i) arm(static_cast<Eigen::Index>(i)) += mesh.points[k + i];
    arms_.push_back(arm);
  }
}

/// (nodes, dim) values of a field that is a function of the arm.
template <class Value>
void RigidMap::fill(std::span<double> out, Value value) const {
  const std::size_t dim = index(body_.dim());
  for (std::size_t node = 0; node < arms_.size(); ++node) {
    const Eigen::Vector3d at = value(arms_[node]);
    for (std::size_t i = 0; i < dim; ++i) out[node * dim + i] = at(static_cast<Eigen::Index>(i));
  }
}

/// (R - 1) r without the difference: small turns keep their digits.
void RigidMap::displacement(std::span<const double> q, std::span<double> u) const {
  const Pose pose = body_.pose(q);
  const Eigen::Vector3d vector = pose.attitude.vec();
  fill(u, [&](const Eigen::Vector3d& arm) -> Eigen::Vector3d {
    const Eigen::Vector3d half = vector.cross(arm);
    return pose.displacement + 2.0 * (pose.attitude.w() * half + vector.cross(half));
  });
}

void RigidMap::velocity(std::span<const double> q, std::span<const double> v,
                        std::span<double> out) const {
  const Eigen::Matrix3d turn = body_.pose(q).attitude.toRotationMatrix();
  const Twist twist = body_.twist(q, v);
  fill(out, [&](const Eigen::Vector3d& arm) -> Eigen::Vector3d {
    return twist.velocity + twist.angular.cross(Eigen::Vector3d(turn * arm));
  });
}

void RigidMap::acceleration(std::span<const double> q, std::span<const double> v,
                            std::span<const double> a, std::span<double> out) const {
  const Eigen::Matrix3d turn = body_.pose(q).attitude.toRotationMatrix();
  const Eigen::Vector3d angular = body_.twist(q, v).angular;
  const Twist rate = body_.acceleration(q, v, a);
  fill(out, [&](const Eigen::Vector3d& arm) -> Eigen::Vector3d {
    const Eigen::Vector3d present = turn * arm;
    return rate.velocity + rate.angular.cross(present) + angular.cross(angular.cross(present));
  });
}

void RigidMap::lift(std::span<const double> q, std::span<const double> nodal, Vector& force) const {
  const Eigen::Matrix3d turn = body_.pose(q).attitude.toRotationMatrix();
  const std::size_t dim = index(body_.dim());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
  for (std::size_t node = 0; node < arms_.size(); ++node) {
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < dim; ++i) f(static_cast<Eigen::Index>(i)) = nodal[node * dim + i];
    sum += f;
    moment += Eigen::Vector3d(turn * arms_[node]).cross(f);
  }
  force.head(body_.dim()) += sum.head(body_.dim());
  if (body_.dim() == 2) force(2) += moment(2);
  if (body_.dim() == 3) force.tail<3>() += moment;
}

}  // namespace abut
