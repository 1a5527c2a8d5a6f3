#include "subdomain_solver/fe/cell_kernel.hpp"

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "base/assert.hpp"

namespace abut {

namespace {

constexpr std::array<int, 9> entries_in_space = {0, 1, 2, 3, 4, 5, 6, 7, 8};
constexpr std::array<int, 5> entries_in_plane = {0, 1, 3, 4, 8};  // 11, 21, 12, 22, 33

/// Entries i + 3 J of F that vary.
std::span<const int> entries(int dim) {
  if (dim == 3) return entries_in_space;
  return entries_in_plane;
}

}  // namespace

int CellKernel::history_size() const { return material_.history_size(); }

bool CellKernel::evaluate(const CellGeometry& cell, std::span<const double> u,
                          std::span<const double> before, std::span<double> after, Want want,
                          CellResponse& out) {
  dim_ = cell.dim;
  points_.resize(static_cast<std::size_t>(cell.points));
  deform(cell, u);
  if (formulation_ == Formulation::mean_dilatation && !average_volume(cell)) return false;
  if (!respond(cell, before, after, want, out)) return false;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    fill_operator(cell, p, points_[p].b);
    if (formulation_ == Formulation::mean_dilatation) average_operator(points_[p]);
  }
  add_force(cell, out);
  if (want == Want::tangent) {
    add_tangent(cell, out);
    if (formulation_ == Formulation::mean_dilatation && !material_.is_linear())
      add_geometric(cell, out);
  }
  return true;
}

void CellKernel::deform(const CellGeometry& cell, std::span<const double> u) {
  const std::size_t nodes = static_cast<std::size_t>(cell.nodes);
  const std::size_t dim = static_cast<std::size_t>(cell.dim);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Matrix3& f = points_[p].f;
    f.setIdentity();
    const double* g = cell.gradient.data() + p * nodes * dim;
    for (std::size_t a = 0; a < nodes; ++a) {
      for (std::size_t j = 0; j < dim; ++j) {
        for (std::size_t i = 0; i < dim; ++i)
          f(static_cast<int>(i), static_cast<int>(j)) += u[a * dim + i] * g[a * dim + j];
      }
      if (!cell.hoop.empty()) f(2, 2) += u[a * dim] * cell.hoop[p * nodes + a];
    }
  }
}

/// One volume change for the whole cell: the mean of det F (of the trace, when linear) [M.44].
bool CellKernel::average_volume(const CellGeometry& cell) {
  const bool linear = material_.is_linear();
  double volume = 0.0;
  dilatation_ = 0.0;
  mean_gradient_.setZero(cell.nodes * dim_);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    point.jacobian = linear ? 1.0 : point.f.determinant();
    if (!(point.jacobian > 0.0)) return false;
    point.inverse = linear ? Matrix3(Matrix3::Identity()) : Matrix3(point.f.inverse());
    fill_operator(cell, p, point.b);
    const double weight = cell.volume[p];
    volume += weight;
    dilatation_ += weight * (linear ? point.f.trace() - 3.0 : point.jacobian);
    mean_gradient_ +=
        weight * point.jacobian * (point.b.transpose() * vary(point.inverse.transpose()));
  }
  dilatation_ /= volume;
  mean_gradient_ /= volume;
  for (Point& point : points_) {
    if (linear) {
      point.f.diagonal().array() += (dilatation_ - (point.f.trace() - 3.0)) / 3.0;
    } else {
      point.stretch = std::cbrt(dilatation_ / point.jacobian);
      point.f *= point.stretch;
    }
  }
  return true;
}

bool CellKernel::respond(const CellGeometry& cell, std::span<const double> before,
                         std::span<double> after, Want want, CellResponse& out) {
  out.stored = out.dissipation = 0.0;
  const std::size_t each = static_cast<std::size_t>(history_size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    if (!material_.evaluate(point.f, before.subspan(p * each, each), after.subspan(p * each, each),
                            want, point.response))
      return false;
    out.stored += cell.volume[p] * point.response.energy;
    out.dissipation += cell.volume[p] * point.response.dissipation;
  }
  return true;
}

CellKernel::Components CellKernel::vary(const Matrix3& tensor) const {
  const std::span<const int> list = entries(dim_);
  Components out(static_cast<Eigen::Index>(list.size()));
  for (std::size_t c = 0; c < list.size(); ++c)
    out(static_cast<Eigen::Index>(c)) = tensor.data()[list[c]];
  return out;
}

/// dF = B du, pointwise.
void CellKernel::fill_operator(const CellGeometry& cell, std::size_t p, Operator& b) const {
  b.setZero(dim_ == 3 ? 9 : 5, cell.nodes * dim_);
  const std::size_t at = p * static_cast<std::size_t>(cell.nodes);
  for (int a = 0; a < cell.nodes; ++a) {
    const std::size_t node = at + static_cast<std::size_t>(a);
    const double* gradient = cell.gradient.data() + node * static_cast<std::size_t>(dim_);
    for (int j = 0; j < dim_; ++j) {
      for (int i = 0; i < dim_; ++i) b(i + dim_ * j, a * dim_ + i) = gradient[j];
    }
    if (!cell.hoop.empty()) b(4, a * dim_) = cell.hoop[node];
  }
}

/// The same of the mean-dilatation forms. Fbar = s F with s = (theta / J)^(1/3), so that
/// dFbar = s dF + Fbar (dtheta / theta - F^-T : dF) / 3; linear: dF + I (dtheta - tr dF) / 3.
void CellKernel::average_operator(Point& point) {
  const bool linear = material_.is_linear();
  const Eigen::RowVectorXd change = mean_gradient_.transpose() / (linear ? 1.0 : dilatation_) -
                                    vary(point.inverse.transpose()).transpose() * point.b;
  point.b *= point.stretch;
  point.b.noalias() += vary(linear ? Matrix3(Matrix3::Identity()) : point.f) * change / 3.0;
}

void CellKernel::add_force(const CellGeometry& cell, CellResponse& out) const {
  out.force.setZero(cell.nodes * dim_);
  for (std::size_t p = 0; p < points_.size(); ++p)
    out.force.noalias() +=
        points_[p].b.transpose() * (cell.volume[p] * vary(points_[p].response.stress));
}

void CellKernel::add_tangent(const CellGeometry& cell, CellResponse& out) {
  const int size = cell.nodes * cell.dim;
  out.tangent.setZero(size, size);
  const std::span<const int> list = entries(cell.dim);
  const Eigen::Index count = static_cast<Eigen::Index>(list.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9> moduli(count, count);
  for (int p = 0; p < cell.points; ++p) {
    const Point& point = points_[static_cast<std::size_t>(p)];
    for (Eigen::Index c = 0; c < count; ++c) {
      for (Eigen::Index r = 0; r < count; ++r)
        moduli(r, c) = cell.volume[static_cast<std::size_t>(p)] *
                       point.response.tangent(list[static_cast<std::size_t>(r)],
                                              list[static_cast<std::size_t>(c)]);
    }
    scaled_.noalias() = moduli * point.b;
    out.tangent.noalias() += point.b.transpose() * scaled_;
  }
}

/// F^-T dF^T F^-T : dF' over all pairs of nodal displacements: for dF = e_i x G_a and
/// dF' = e_k x G_b it is g_a(k) g_b(i) with g = F^-T G.
void CellKernel::fill_exchange(const CellGeometry& cell, std::size_t p) {
  const Matrix3& inverse = points_[p].inverse;
  const Eigen::Map<const Eigen::MatrixXd> reference(
      cell.gradient.data() + p * static_cast<std::size_t>(cell.nodes * dim_), dim_, cell.nodes);
  const Eigen::MatrixXd g = inverse.topLeftCorner(dim_, dim_).transpose() * reference;
  for (int a = 0; a < cell.nodes; ++a) {
    for (int b = 0; b < cell.nodes; ++b) {
      exchange_.block(a * dim_, b * dim_, dim_, dim_).noalias() = g.col(b) * g.col(a).transpose();
      if (cell.hoop.empty()) continue;
      const std::size_t at = p * static_cast<std::size_t>(cell.nodes);
      exchange_(a * dim_, b * dim_) += cell.hoop[at + static_cast<std::size_t>(a)] *
                                       cell.hoop[at + static_cast<std::size_t>(b)] * inverse(2, 2) *
                                       inverse(2, 2);
    }
  }
}

/// Second variation of Fbar at constant stress [M.45]: with d = dtheta / theta - F^-T : dF and
/// w = P : Fbar,
///   s/3 (P:dF d' + P:dF' d) + w/9 d d' + w/3 (F^-T dF^T F^-T : dF' - dtheta dtheta' / theta^2)
///   + w/3 d2(theta) / theta.
void CellKernel::add_geometric(const CellGeometry& cell, CellResponse& out) {
  const int size = cell.nodes * dim_;
  double volume = 0.0, mean_work = 0.0;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    volume += cell.volume[p];
    mean_work += cell.volume[p] * points_[p].response.stress.cwiseProduct(points_[p].f).sum();
  }
  mean_work /= 3.0 * dilatation_ * volume;
  exchange_.resize(size, size);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& point = points_[p];
    const double weight = cell.volume[p];
    const double w = point.response.stress.cwiseProduct(point.f).sum();
    fill_operator(cell, p, scaled_);
    fill_exchange(cell, p);
    const Eigen::VectorXd spread = scaled_.transpose() * vary(point.inverse.transpose());
    const Eigen::VectorXd change = mean_gradient_ / dilatation_ - spread;
    const Eigen::VectorXd work =
        point.stretch * (scaled_.transpose() * vary(point.response.stress));
    Eigen::MatrixXd& k = out.tangent;
    k += weight / 3.0 * (work * change.transpose() + change * work.transpose());
    k += weight * w / 9.0 * change * change.transpose();
    k -= weight * w / (3.0 * dilatation_ * dilatation_) * mean_gradient_ *
         mean_gradient_.transpose();
    k += weight * w / 3.0 * exchange_;
    k += mean_work * weight * point.jacobian * (spread * spread.transpose() - exchange_);
  }
}

}  // namespace abut
