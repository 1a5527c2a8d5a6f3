#include "subdomain_solver/rigid/rigid_model.hpp"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/assert.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// The first numbers of a list as a vector of space.
Eigen::Vector3d leading(std::span<const double> list, int dim) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int i = 0; i < dim; ++i) out(i) = list[i];
  return out;
}

Eigen::Vector3d last(std::span<const double> list) {
  const std::size_t n = list.size();
  return {list[n - 3], list[n - 2], list[n - 1]};
}

/// Mass and its first and second moments by a mass matrix, exact for what is linear in x.
struct Moments {
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // of x - centre

  Moments(const FeModel& mesh, MassForm form) {
    const int dim = mesh.mesh().dim, nodes = mesh.mesh().node_count();
    const SparseMatrix matrix = mass_matrix(mesh, form);
    const auto points = view(mesh.mesh().points);
    const auto component = [dim, nodes](const Vector& values, int i) -> Vector {
      return values(Eigen::seqN(i, nodes, dim));
    };
    // Rows of one component alone: every component has the same matrix.
    const auto times = [&](const Vector& nodal) -> Vector {
      Vector all = Vector::Zero(points.size());
      all(Eigen::seqN(0, nodes, dim)) = nodal;
      return component(matrix * all, 0);
    };
    const Vector share = times(Vector::Ones(nodes));
    mass = share.sum();
    std::array<Vector, 3> arm, heavy;
    for (int i = 0; i < dim; ++i) {
      centre(i) = share.dot(component(points, i)) / mass;
      arm[i] = component(points, i).array() - centre(i);
      heavy[i] = times(arm[i]);
    }
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) second(i, j) = arm[i].dot(heavy[j]);
    }
  }
};

}  // namespace

RigidModel::RigidModel(const FeModel& mesh, MassForm form) : dim_(mesh.mesh().dim) {
  ABUT_ASSERT(!mesh.round());
  const Moments moments(mesh, form);
  centre_ = moments.centre;
  lumped_ = Vector::Constant(dim_ == 3 ? 6 : 2 * dim_ - 1, moments.mass);
  if (dim_ == 2) lumped_(2) = moments.second.trace();
  if (dim_ == 3) {
    lumped_.tail<3>().setOnes();  // of angular momentum, whose rate is the moment
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments.second);
    Eigen::Matrix3d axes = eigen.eigenvectors();
    if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
    axes_ = Eigen::Quaterniond(axes).normalized();
    rotation_.emplace(eigen.eigenvalues().cwiseMax(0.0));
  }
  mass_ = SparseMatrix(lumped_.asDiagonal());
}

bool RigidModel::evaluate(std::span<const double>, std::span<const double>, Want want,
                          ModelResponse& out) {
  out = {};
  out.force = Vector::Zero(dofs());
  if (want == Want::tangent) out.tangent = SparseMatrix(dofs(), dofs());
  return true;
}

Pose RigidModel::pose(std::span<const double> q) const {
  Pose out;
  out.displacement = leading(q, dim_);
  if (dim_ == 2)
    out.attitude = Eigen::Quaterniond(std::cos(0.5 * q[2]), 0.0, 0.0, std::sin(0.5 * q[2]));
  if (dim_ == 3) out.attitude = Eigen::Quaterniond(q[3], q[4], q[5], q[6]);
  return out;
}

Eigen::Matrix3d RigidModel::inertia(const Eigen::Quaterniond& attitude) const {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  if (dim_ == 2) out(2, 2) = lumped_(2);
  if (dim_ < 3) return out;
  const Eigen::Matrix3d axes = (attitude * axes_).toRotationMatrix();
  return axes * rotation_->inertia().asDiagonal() * axes.transpose();
}

Eigen::Vector3d RigidModel::angular_velocity(const Eigen::Quaterniond& attitude,
                                             const Eigen::Vector3d& momentum) const {
  if (dim_ == 1) return Eigen::Vector3d::Zero();
  if (dim_ == 2) return {0.0, 0.0, momentum(2) / lumped_(2)};
  const Eigen::Quaterniond axes = attitude * axes_;
  const Eigen::Vector3d along = axes.conjugate() * momentum;
  return axes * Eigen::Vector3d(along.cwiseQuotient(rotation_->inertia()));
}

Twist RigidModel::twist(std::span<const double> q, std::span<const double> v) const {
  Twist out;
  out.velocity = leading(v, dim_);
  if (dim_ == 2) out.angular(2) = v[2];
  if (dim_ == 3) out.angular = angular_velocity(pose(q).attitude, last(v));
  return out;
}

/// I w' = L' - w x L in space.
Twist RigidModel::acceleration(std::span<const double> q, std::span<const double> v,
                               std::span<const double> a) const {
  Twist out;
  out.velocity = leading(a, dim_);
  if (dim_ == 2) out.angular(2) = a[2];
  if (dim_ == 3) {
    const Eigen::Vector3d momentum = last(v);
    out.angular = angular_velocity(pose(q).attitude, last(a) - twist(q, v).angular.cross(momentum));
  }
  return out;
}

Eigen::Vector3d RigidModel::angular_momentum(std::span<const double> v) const {
  if (dim_ == 3) return last(v);
  return {0.0, 0.0, dim_ == 2 ? lumped_(2) * v[2] : 0.0};
}

double RigidModel::kinetic(std::span<const double> q, std::span<const double> v) const {
  const Twist now = twist(q, v);
  return 0.5 * total_mass() * now.velocity.squaredNorm() +
         0.5 * now.angular.dot(angular_momentum(v));
}

double RigidModel::power(std::span<const double> q, std::span<const double> v,
                         const Vector& force) const {
  const Twist now = twist(q, v);
  const std::span<const double> parts = span_of(force);
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  if (dim_ == 2) moment(2) = force(2);
  if (dim_ == 3) moment = last(parts);
  return leading(parts, dim_).dot(now.velocity) + moment.dot(now.angular);
}

std::vector<double> RigidModel::coordinates(const Pose& pose) const {
  const Eigen::Vector3d& d = pose.displacement;
  const Eigen::Quaterniond& turn = pose.attitude;
  if (dim_ == 1) return {d(0)};
  if (dim_ == 2) return {d(0), d(1), 2.0 * std::atan2(turn.z(), turn.w())};
  return {d(0), d(1), d(2), turn.w(), turn.x(), turn.y(), turn.z()};
}

std::vector<double> RigidModel::rates(const Pose& pose, const Twist& twist) const {
  const Eigen::Vector3d& v = twist.velocity;
  if (dim_ == 1) return {v(0)};
  if (dim_ == 2) return {v(0), v(1), twist.angular(2)};
  const Eigen::Vector3d momentum = inertia(pose.attitude) * twist.angular;
  return {v(0), v(1), v(2), momentum(0), momentum(1), momentum(2)};
}

void RigidModel::drift(std::span<double> q, std::span<const double> v, double time) const {
  if (dim_ < 3) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += time * v[i];
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) q[i] += time * v[i];
  const Eigen::Quaterniond attitude = pose(q).attitude;
  const Eigen::Vector3d momentum = (attitude * axes_).conjugate() * last(v);
  const Eigen::Quaterniond turn = rotation_->turn(momentum, time);
  const Eigen::Vector3d vector = axes_ * Eigen::Vector3d(turn.vec());
  const Eigen::Quaterniond next =
      (attitude * Eigen::Quaterniond(turn.w(), vector(0), vector(1), vector(2))).normalized();
  q[3] = next.w();
  q[4] = next.x();
  q[5] = next.y();
  q[6] = next.z();
}

/// The energy of rotation stays, and no moment of inertia is below the least.
double RigidModel::fastest_turn(std::span<const double> q, std::span<const double> v) const {
  if (dim_ == 1) return 0.0;
  if (dim_ == 2) return std::abs(v[2]);
  return std::sqrt(twist(q, v).angular.dot(last(v)) / rotation_->inertia().minCoeff());
}

}  // namespace abut
