#include "subdomain_solver/fe/cell_kernel.hpp"

#include <cmath>

#include <Eigen/LU>

#include "base/index.hpp"
#include "subdomain_solver/materials/crush_guard.hpp"
#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

int CellKernel::history_size() const { return material_.history_size(); }

bool CellKernel::evaluate(const CellGeometry& cell, std::span<const double> u,
                          std::span<const double> before, std::span<double> after, Need want,
                          CellResponse& out) {
  if (!evaluate_points(cell, u, before, after, want, out)) return false;
  if (!cell.hourglass.empty()) add_hourglass(cell, u, want, out);
  return true;
}

/// Every component of u on its own, with one stiffness for all or one for each.
void CellKernel::add_hourglass(const CellGeometry& cell, std::span<const double> u, Need want,
                               CellResponse& out) {
  const std::size_t n = index(cell.nodes);
  const bool alike = cell.hourglass.size() == n * n;
  const Eigen::Map<const Eigen::MatrixXd> moved(u.data(), cell.dim, cell.nodes);
  Eigen::Map<Eigen::MatrixXd> force(out.force.data(), cell.dim, cell.nodes);
  for (int i = 0; i < cell.dim; ++i) {
    const double* first = cell.hourglass.data() + (alike ? 0 : index(i) * n * n);
    const Eigen::Map<const Eigen::MatrixXd> k(first, cell.nodes, cell.nodes);
    Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 8> own;  // cells are linear
    own.noalias() = moved.row(i) * k;
    out.stored += 0.5 * own.dot(moved.row(i));
    force.row(i) += own;
    if (want != Need::tangent) continue;
    for (int a = 0; a < cell.nodes; ++a)
      for (int b = 0; b < cell.nodes; ++b)
        out.tangent(a * cell.dim + i, b * cell.dim + i) += k(a, b);
  }
}

bool CellKernel::evaluate_points(const CellGeometry& cell, std::span<const double> u,
                                 std::span<const double> before, std::span<double> after, Need want,
                                 CellResponse& out) {
  fields_ = cell.dilatation;
  fill_operators(cell);
  deform(u);
  if (!fields_.empty() && !average_volume()) return false;
  if (!respond(before, after, want, out)) return false;
  if (!fields_.empty()) split_force();
  out.force.resize(nodes_ * dim_);
  integrate(&Point::force, {}, out.force);
  if (want == Need::stress) return true;
  if (!fields_.empty()) split_moduli();
  integrate_moduli(out.tangent);
  if (!fields_.empty()) couple_fields(out.tangent);
  return true;
}

/// Displacements along a direction i change F_i1, F_i2, F_i3 in space; in the plane the third is
/// F33, by the hoop strain of radial ones, and along a line only the first changes: B is zero in
/// the other columns. Rows and columns of tensors as Eigen stores them.
int CellKernel::entry(int direction, int column) const {
  return dim_ == 3 || column < 2 ? direction + 3 * column : 8;
}

const Eigen::MatrixXd& CellKernel::along(int direction) const {
  return b_[dim_ == 3 ? 0 : index(direction)];
}

void CellKernel::fill_operators(const CellGeometry& cell) {
  dim_ = cell.dim;
  nodes_ = cell.nodes;
  points_.resize(index(cell.points));
  for (int p = 0; p < cell.points; ++p) points_[p].volume = cell.volume[p];
  for (std::size_t i = 0; i < (dim_ == 2 ? 2 : 1); ++i) {
    b_[i].setZero(nodes_, 3 * cell.points);
    for (int p = 0; p < cell.points; ++p) {
      const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(p) * nodes_;
      const double* gradient = cell.gradient.data() + first * dim_;
      for (int a = 0; a < nodes_; ++a) {
        for (int j = 0; j < dim_; ++j) b_[i](a, 3 * p + j) = gradient[a * dim_ + j];
        if (i == 0 && !cell.hoop.empty()) b_[i](a, 3 * p + 2) = cell.hoop.data()[first + a];
      }
    }
  }
}

void CellKernel::deform(std::span<const double> u) {
  for (Point& point : points_) point.f.setIdentity();
  for (int i = 0; i < dim_; ++i) {
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
      for (int j = 0; j < 3; ++j) {
        const double* b = along(i).col(3 * p + j).data();
        double sum = 0.0;
        for (int a = 0; a < nodes_; ++a) sum += b[a] * u[a * dim_ + i];
        points_[p].f.data()[entry(i, j)] += sum;
      }
    }
  }
}

/// A field with these amounts of the cell's fields, at a point.
double CellKernel::in_fields(std::size_t point, const Eigen::VectorXd& amounts) const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < amounts.size(); ++k)
    sum += amounts(k) * fields_[index(k) * points_.size() + point];
  return sum;
}

/// The part of det F (of the trace, when linear) that the cell's fields hold, in place of it
/// [M.44].
bool CellKernel::average_volume() {
  const bool linear = material_.is_linear();
  volume_ = 0.0;
  for (Point& point : points_) {
    volume_ += point.volume;
    if (linear) continue;
    point.jacobian = point.f.determinant();
    if (!(point.jacobian > 0.0)) return false;
    point.inverse = point.f.inverse().transpose();
  }
  amounts_.setZero(static_cast<Eigen::Index>(fields_.size() / points_.size()));
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const Point& point = points_[k % points_.size()];
    amounts_(static_cast<Eigen::Index>(k / points_.size())) +=
        point.volume / volume_ * fields_[k] * (linear ? point.f.trace() - 3.0 : point.jacobian);
  }
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    const double change = in_fields(p, amounts_);
    if (linear) {
      point.f.diagonal().array() += (change - (point.f.trace() - 3.0)) / 3.0;
      continue;
    }
    if (!(change > 0.0)) return false;
    point.dilatation = change;
    point.stretch = std::cbrt(change / point.jacobian);
    point.f *= point.stretch;
    point.carrier = point.f;
  }
  return true;
}

bool CellKernel::respond(std::span<const double> before, std::span<double> after, Need want,
                         CellResponse& out) {
  out.stored = out.dissipation = 0.0;
  const std::size_t each = index(history_size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    if (!material_.evaluate(point.f, before.subspan(p * each, each), after.subspan(p * each, each),
                            want, point.response))
      return false;
    if (guarded_)
      guard_against_crushing(point.f, material_.moduli().p_wave(), want, point.response);
    out.stored += point.volume * point.response.energy;
    out.dissipation += point.volume * point.response.dissipation;
    point.force = point.volume * point.response.stress;
    if (want == Need::tangent) point.moduli = point.volume * point.response.tangent;
  }
  return true;
}

/// Turns P at Fbar = s F, s = (theta / J)^(1/3), into S of F. With Y = F^-T and w = P : Fbar,
///   dFbar = s dF + Fbar d/3,   d = dtheta / theta - Y : dF;   linear: dF + I (dtheta - tr dF)/3.
/// w / (3 theta) works on theta; the projection that makes theta of J is its own adjoint, so that
/// the same projection of w / (3 theta) works on J.
void CellKernel::split_force() {
  amounts_.setZero();
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const Point& point = points_[k % points_.size()];
    const double work = point.response.stress.cwiseProduct(point.carrier).sum();
    amounts_(static_cast<Eigen::Index>(k / points_.size())) +=
        point.volume / volume_ * fields_[k] * work / (3.0 * point.dilatation);
  }
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    const Matrix3& stress = point.response.stress;
    const double third = stress.cwiseProduct(point.carrier).sum() / 3.0;  // w/3
    point.pressure = in_fields(p, amounts_) * point.jacobian;
    point.force =
        point.volume * (point.stretch * stress + (point.pressure - third) * point.inverse);
  }
}

/// The same of A, with the second variation of Fbar at constant P where there is one:
///   s/3 (P:dF d' + P:dF' d) + w/9 d d' + w/3 (Y dF^T Y : dF' - dtheta dtheta' / theta^2)
///   + w/3 d2(theta) / theta.
/// What theta and F have in common becomes the points' coupling.
void CellKernel::split_moduli() {
  const double geometric = material_.is_linear() ? 0.0 : 1.0;
  for (Point& point : points_) {
    const double theta = point.dilatation;
    const Matrix3& y = point.inverse;
    const Matrix3 p = geometric * point.response.stress;
    const double third = p.cwiseProduct(point.carrier).sum() / 3.0;
    const double swelling = geometric * point.pressure;
    Matrix3 t;
    t.reshaped() = point.response.tangent * point.carrier.reshaped();
    const double c = (t.cwiseProduct(point.carrier).sum() + 3.0 * third) / 9.0;
    t = point.stretch / 3.0 * (t + p);
    point.moduli = point.volume * (point.stretch * point.stretch * point.response.tangent -
                                   outer(t, y) - outer(y, t) + (c + swelling) * outer(y, y) +
                                   (third - swelling) * crossed(y, y));
    point.coupling = point.volume / theta * (t - c * y);
    point.stiffness = point.volume * (c - third) / (theta * theta);
    point.swell = point.volume * point.jacobian * y;
  }
}

/// Adds the sum over the fields k of g_k m_k^T + m_k g_k^T: m_k is the derivative of what there is
/// of a field by displacement, g_k couples it to F and has half of the fields' own stiffness.
void CellKernel::couple_fields(Eigen::MatrixXd& tangent) {
  const Eigen::Index count = amounts_.size(), points = static_cast<Eigen::Index>(points_.size());
  swelling_.resize(tangent.rows(), count);
  coupling_.resize(tangent.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::span<const double> field = fields_.subspan(index(k * points), points_.size());
    integrate(&Point::swell, field, swelling_.col(k));
    integrate(&Point::coupling, field, coupling_.col(k));
  }
  swelling_ /= volume_;
  const Eigen::Map<const Eigen::MatrixXd> fields(fields_.data(), points, count);
  stiffness_.setZero(count, count);
  for (Eigen::Index p = 0; p < points; ++p) {
    const double own = points_[p].stiffness;
    stiffness_.noalias() += own * fields.row(p).transpose() * fields.row(p);
  }
  added_.noalias() = 0.5 * swelling_ * stiffness_;
  coupling_ += added_;
  tangent.noalias() += coupling_ * swelling_.transpose();
  tangent.noalias() += swelling_ * coupling_.transpose();
}

/// Sum over the points of B^T S, times their weights where there are some.
void CellKernel::integrate(Matrix3 Point::*field, std::span<const double> weights,
                           Eigen::Ref<Eigen::VectorXd> out) {
  entries_.resize(3 * static_cast<Eigen::Index>(points_.size()));
  for (int i = 0; i < dim_; ++i) {
    int column = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const double weight = weights.empty() ? 1.0 : weights[p];
      for (int j = 0; j < 3; ++j)
        entries_(column++) = weight * (points_[p].*field).data()[entry(i, j)];
    }
    Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>(
        out.data() + i, nodes_, Eigen::InnerStride<>(dim_)) = along(i).lazyProduct(entries_);
  }
}

/// Sum over the points of B^T D B, for one pair of directions after the other: no entry of these
/// matrices is zero in space.
void CellKernel::integrate_moduli(Eigen::MatrixXd& out) {
  const int size = nodes_ * dim_;
  out.resize(size, size);
  using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  using Pair = Eigen::Map<Eigen::MatrixXd, 0, Stride>;
  const Stride stride(dim_ * size, dim_);
  scaled_.resize(nodes_, 3 * static_cast<Eigen::Index>(points_.size()));
  for (int i = 0; i < dim_; ++i) {
    for (int k = i; k < dim_; ++k) {
      int column = 0;
      for (const Point& point : points_) {
        Matrix3 d;
        for (int j = 0; j < 3; ++j) {
          for (int l = 0; l < 3; ++l) d(j, l) = point.moduli(entry(i, j), entry(k, l));
        }
        scaled_.middleCols<3>(column) = along(i).middleCols<3>(column).lazyProduct(d);
        column += 3;
      }
      part_.noalias() = scaled_ * along(k).transpose();
      Pair(out.data() + i + k * size, nodes_, nodes_, stride) = part_;
      Pair(out.data() + k + i * size, nodes_, nodes_, stride) = part_.transpose();
    }
  }
}

}  // namespace abut
