#include "subdomain_solver/fe/cell_kernel.hpp"

#include <cmath>

#include <Eigen/LU>

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

int CellKernel::history_size() const { return material_.history_size(); }

bool CellKernel::evaluate(const CellGeometry& cell, std::span<const double> u,
                          std::span<const double> before, std::span<double> after, Want want,
                          CellResponse& out) {
  if (!evaluate_points(cell, u, before, after, want, out)) return false;
  if (!cell.hourglass.empty()) add_hourglass(cell, u, want, out);
  return true;
}

/// Every component of u on its own.
void CellKernel::add_hourglass(const CellGeometry& cell, std::span<const double> u, Want want,
                               CellResponse& out) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> k(cell.hourglass.data(), cell.nodes, cell.nodes);
  const Eigen::Map<const Rows> moved(u.data(), cell.nodes, cell.dim);
  const Rows force = k * moved;
  out.stored += 0.5 * force.cwiseProduct(moved).sum();
  out.force += force.reshaped<Eigen::RowMajor>();
  if (want != Want::tangent) return;
  for (int a = 0; a < cell.nodes; ++a) {
    for (int b = 0; b < cell.nodes; ++b)
      out.tangent.block(a * cell.dim, b * cell.dim, cell.dim, cell.dim).diagonal().array() +=
          k(a, b);
  }
}

bool CellKernel::evaluate_points(const CellGeometry& cell, std::span<const double> u,
                                 std::span<const double> before, std::span<double> after, Want want,
                                 CellResponse& out) {
  const bool average = formulation_ == Formulation::mean_dilatation;
  fill_operators(cell);
  deform(u);
  if (average && !average_volume()) return false;
  if (!respond(before, after, want, out)) return false;
  const double on_mean = average ? split_force() : 0.0;
  integrate(&Point::force, out.force);
  if (average) out.force += on_mean * mean_gradient_;
  if (want == Want::stress) return true;
  const double of_mean = average ? split_moduli(on_mean) : 0.0;
  integrate_moduli(out.tangent);
  if (!average) return true;
  integrate(&Point::coupling, coupling_);
  coupling_ += 0.5 * of_mean * mean_gradient_;
  out.tangent.noalias() += coupling_ * mean_gradient_.transpose();
  out.tangent.noalias() += mean_gradient_ * coupling_.transpose();
  return true;
}

/// Displacements along a direction i change F_i1, F_i2, F_i3 in space; in the plane the third is
/// F33, by the hoop strain of radial ones, and along a line only the first changes: B is zero in
/// the other columns. Rows and columns of tensors as Eigen stores them.
int CellKernel::entry(int direction, int column) const {
  return dim_ == 3 || column < 2 ? direction + 3 * column : 8;
}

const Eigen::MatrixXd& CellKernel::along(int direction) const {
  return b_[dim_ == 3 ? 0 : static_cast<std::size_t>(direction)];
}

void CellKernel::fill_operators(const CellGeometry& cell) {
  dim_ = cell.dim;
  nodes_ = cell.nodes;
  points_.resize(static_cast<std::size_t>(cell.points));
  for (int p = 0; p < cell.points; ++p)
    points_[static_cast<std::size_t>(p)].volume = cell.volume[static_cast<std::size_t>(p)];
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
        for (int a = 0; a < nodes_; ++a) sum += b[a] * u[static_cast<std::size_t>(a * dim_ + i)];
        points_[static_cast<std::size_t>(p)].f.data()[entry(i, j)] += sum;
      }
    }
  }
}

/// One volume change for the whole cell: the mean of det F (of the trace, when linear) [M.44].
bool CellKernel::average_volume() {
  const bool linear = material_.is_linear();
  volume_ = dilatation_ = 0.0;
  for (Point& point : points_) {
    if (!linear) {
      point.jacobian = point.f.determinant();
      if (!(point.jacobian > 0.0)) return false;
      point.inverse = point.f.inverse().transpose();
    }
    volume_ += point.volume;
    dilatation_ += point.volume * (linear ? point.f.trace() - 3.0 : point.jacobian);
  }
  dilatation_ /= volume_;
  for (Point& point : points_) {
    point.swell = point.volume / volume_ * point.jacobian * point.inverse;
    if (linear) {
      point.f.diagonal().array() += (dilatation_ - (point.f.trace() - 3.0)) / 3.0;
    } else {
      point.stretch = std::cbrt(dilatation_ / point.jacobian);
      point.f *= point.stretch;
      point.carrier = point.f;
    }
  }
  integrate(&Point::swell, mean_gradient_);
  return true;
}

bool CellKernel::respond(std::span<const double> before, std::span<double> after, Want want,
                         CellResponse& out) {
  out.stored = out.dissipation = 0.0;
  const std::size_t each = static_cast<std::size_t>(history_size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    if (!material_.evaluate(point.f, before.subspan(p * each, each), after.subspan(p * each, each),
                            want, point.response))
      return false;
    out.stored += point.volume * point.response.energy;
    out.dissipation += point.volume * point.response.dissipation;
    point.force = point.volume * point.response.stress;
    if (want == Want::tangent) point.moduli = point.volume * point.response.tangent;
  }
  return true;
}

/// Turns P at Fbar = s F, s = (theta / J)^(1/3), into S of F. With Y = F^-T and w = P : Fbar,
///   dFbar = s dF + Fbar d/3,   d = dtheta / theta - Y : dF;   linear: dF + I (dtheta - tr dF)/3.
/// Returns the force that works on theta, the same change of volume at all points.
double CellKernel::split_force() {
  double on_mean = 0.0;
  for (Point& point : points_) {
    const Matrix3& p = point.response.stress;
    const double third = p.cwiseProduct(point.carrier).sum() / 3.0;  // w/3
    point.force = point.volume * (point.stretch * p - third * point.inverse);
    on_mean += point.volume * third;
  }
  return on_mean / mean_scale();
}

/// The same of A, with the second variation of Fbar at constant P where there is one:
///   s/3 (P:dF d' + P:dF' d) + w/9 d d' + w/3 (Y dF^T Y : dF' - dtheta dtheta' / theta^2)
///   + w/3 d2(theta) / theta.
/// Returns the stiffness of theta; what theta and F have in common becomes the points' coupling.
double CellKernel::split_moduli(double on_mean) {
  const double theta = mean_scale();
  const double geometric = material_.is_linear() ? 0.0 : 1.0;
  double of_mean = 0.0;
  for (Point& point : points_) {
    const Matrix3& y = point.inverse;
    const Matrix3 p = geometric * point.response.stress;
    const double third = p.cwiseProduct(point.carrier).sum() / 3.0;
    const double swelling = geometric * on_mean * point.jacobian / volume_;
    Matrix3 t;
    t.reshaped() = point.response.tangent * point.carrier.reshaped();
    const double c = (t.cwiseProduct(point.carrier).sum() + 3.0 * third) / 9.0;
    t = point.stretch / 3.0 * (t + p);
    point.moduli = point.volume * (point.stretch * point.stretch * point.response.tangent -
                                   outer(t, y) - outer(y, t) + (c + swelling) * outer(y, y) +
                                   (third - swelling) * crossed(y, y));
    point.coupling = point.volume / theta * (t - c * y);
    of_mean += point.volume * (c - third) / (theta * theta);
  }
  return of_mean;
}

/// Sum over the points of B^T S.
void CellKernel::integrate(Matrix3 Point::*field, Eigen::VectorXd& out) {
  out.resize(nodes_ * dim_);
  entries_.resize(3 * static_cast<Eigen::Index>(points_.size()));
  for (int i = 0; i < dim_; ++i) {
    int column = 0;
    for (const Point& point : points_) {
      for (int j = 0; j < 3; ++j) entries_(column++) = (point.*field).data()[entry(i, j)];
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
