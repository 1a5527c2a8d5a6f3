#include "coordinator/coupling/port_jacobian.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Boundaries of the intervals over which forces act; interval i is [bounds[i], bounds[i + 1]] and
/// belongs to force `first + i`: dual cells of all nodes 0..n, or the substeps 1..n.
std::vector<double> cells(const Substeps& grid, ForceSupport support) {
  std::vector<double> bounds;
  bounds.push_back(grid.begin);
  if (support == ForceSupport::nodal) {
    for (int i = 1; i <= grid.count; ++i) bounds.push_back(0.5 * (grid.time(i - 1) + grid.time(i)));
    bounds.push_back(grid.end);
  } else {
    for (int i = 1; i <= grid.count; ++i) bounds.push_back(grid.time(i));
  }
  return bounds;
}

/// Mean over every cell of `to` of a function that is constant over the cells of `from` (to, from).
Eigen::MatrixXd overlap_average(const std::vector<double>& to, const std::vector<double>& from) {
  const std::ptrdiff_t rows = static_cast<std::ptrdiff_t>(to.size()) - 1;
  const std::ptrdiff_t cols = static_cast<std::ptrdiff_t>(from.size()) - 1;
  Eigen::MatrixXd average = Eigen::MatrixXd::Zero(rows, cols);
  std::ptrdiff_t first = 0;
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    const double low = to[i];
    const double high = to[index(i) + 1];
    while (first + 1 < cols && from[index(first) + 1] <= low) ++first;
    for (std::ptrdiff_t j = first; j < cols && from[j] < high; ++j) {
      const double overlap = std::min(high, from[index(j) + 1]) - std::max(low, from[j]);
      if (overlap > 0.0) average(i, j) = overlap / (high - low);
    }
  }
  return average;
}

/// Values at the ends of the substeps 1..n of `to` from nodal values 1..m of `from`, linear in time
/// (n, m); the value at the window's begin is known and has no column.
Eigen::MatrixXd interpolation(const Substeps& to, const Substeps& from) {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(to.count, from.count);
  int j = 1;
  for (int i = 1; i <= to.count; ++i) {
    const double t = to.time(i);
    while (j < from.count && from.time(j) < t) ++j;
    const double s =
        std::clamp((t - from.time(j - 1)) / (from.time(j) - from.time(j - 1)), 0.0, 1.0);
    p(i - 1, j - 1) += s;
    if (j > 1) p(i - 1, j - 2) += 1.0 - s;
  }
  return p;
}

Eigen::MatrixXd toeplitz(const std::vector<double>& c, int n) {
  ABUT_ASSERT(static_cast<int>(c.size()) >= n);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) matrix(i, j) = c[i - j];
  }
  return matrix;
}

}  // namespace

Eigen::MatrixXd neumann_map(const PortKernel& kernel, const Substeps& here, const Substeps& source,
                            ForceSupport source_support) {
  const Eigen::MatrixXd response = toeplitz(kernel.displacement, here.count);
  if (here.same_as(source) && kernel.support == source_support) return response;
  const bool nodal = kernel.support == ForceSupport::nodal;
  Eigen::MatrixXd mean =
      overlap_average(cells(here, kernel.support), cells(source, source_support));
  // The source's force at the window's begin is known: its column goes.
  if (source_support == ForceSupport::nodal) mean = mean.rightCols(source.count).eval();
  if (!nodal) return response * mean;
  const Eigen::MatrixXd dynamic = mean.bottomRows(here.count);
  const Eigen::Map<const Eigen::VectorXd> begin(kernel.begin.data(), here.count);
  Eigen::MatrixXd map = response * dynamic + begin * mean.row(0);
  Eigen::MatrixXd instant;  // the force of the instant moves the massless port at once
  if (source_support == ForceSupport::nodal) {
    instant = interpolation(here, source);
  } else {
    instant = Eigen::MatrixXd::Zero(here.count, source.count);
    int j = 1;
    for (int i = 1; i <= here.count; ++i) {
      while (j < source.count && source.time(j) < here.time(i)) ++j;
      instant(i - 1, j - 1) = 1.0;
    }
  }
  map += quasi_static(kernel) * (instant - dynamic);
  return map;
}

ContactMaps contact_maps(const PortKernel& kinematic, const Substeps& kinematic_grid,
                         const PortKernel& neumann, const Substeps& neumann_grid) {
  ContactMaps maps;
  maps.motion = neumann_map(neumann, neumann_grid, kinematic_grid, kinematic.support);
  maps.seen = interpolation(kinematic_grid, neumann_grid);
  maps.overlap = toeplitz(kinematic.displacement, kinematic_grid.count) + maps.seen * maps.motion;
  return maps;
}

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& a, const Eigen::VectorXd& overlap,
                                      const Eigen::VectorXd& force) {
  constexpr int most_passes = 200;
  constexpr double settled = 1.0e-13;  // of the largest change
  Eigen::VectorXd change = Eigen::VectorXd::Zero(force.size());
  for (int pass = 0; pass < most_passes; ++pass) {
    double moved = 0.0;
    for (Eigen::Index i = 0; i < force.size(); ++i) {
      const double left = overlap[i] - a.row(i).dot(change);
      const double next = std::max(-force[i], change[i] + left / a(i, i));
      moved = std::max(moved, std::abs(next - change[i]));
      change[i] = next;
    }
    if (moved <= settled * change.lpNorm<Eigen::Infinity>()) break;
  }
  return change;
}

Eigen::MatrixXd unilateral_jacobian(const PortKernel& kinematic, const Substeps& kinematic_grid,
                                    const PortKernel& neumann, const Substeps& neumann_grid) {
  const Eigen::MatrixXd pushed =
      neumann_map(neumann, neumann_grid, kinematic_grid, kinematic.support);
  const Eigen::MatrixXd own = toeplitz(kinematic.displacement, kinematic_grid.count);
  const Eigen::MatrixXd motion =
      kinematic_grid.same_as(neumann_grid)
          ? Eigen::MatrixXd::Identity(neumann_grid.count, neumann_grid.count)
          : interpolation(kinematic_grid, neumann_grid);
  const Eigen::MatrixXd force = own.triangularView<Eigen::Lower>().solve(motion);
  return Eigen::MatrixXd::Identity(neumann_grid.count, neumann_grid.count) + pushed * force;
}

Eigen::VectorXd solve_toeplitz(const std::vector<double>& column, const Eigen::VectorXd& r) {
  const Eigen::Index n = r.size();
  ABUT_ASSERT(static_cast<Eigen::Index>(column.size()) >= n);
  const Eigen::Map<const Eigen::VectorXd> c(column.data(), n);
  Eigen::VectorXd x = r;
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] /= c[0];
    x.tail(n - i - 1) -= x[i] * c.segment(1, n - i - 1);
  }
  return x;
}

Eigen::VectorXd solve_unilateral(const std::vector<double>& kinematic,
                                 const std::vector<double>& neumann, double normal,
                                 const Eigen::VectorXd& r, const Eigen::VectorXd& overlap,
                                 const Eigen::VectorXd& force) {
  const Eigen::Index n = r.size();
  ABUT_ASSERT(static_cast<Eigen::Index>(std::min(kinematic.size(), neumann.size())) >= n);
  const Eigen::Map<const Eigen::VectorXd> ck(kinematic.data(), n);
  const Eigen::Map<const Eigen::VectorXd> cn(neumann.data(), n);
  const double both = ck[0] + cn[0];
  Eigen::VectorXd left = overlap + normal * r;        // overlap that is left to be removed
  Eigen::VectorXd given = Eigen::VectorXd::Zero(n);   // way that the kinematic side gives
  Eigen::VectorXd pushed = Eigen::VectorXd::Zero(n);  // way that the Neumann side is pushed
  Eigen::VectorXd motion(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double change = std::max(left[i] / both, -force[i]);
    const bool closed = change > -force[i];
    if (change != 0.0) {
      left.tail(n - i) -= change * (ck + cn).head(n - i);
      given.tail(n - i) += change * ck.head(n - i);
      pushed.tail(n - i) += change * cn.head(n - i);
    }
    // Where the sides touch both differences are the same; the one of the stiffer side keeps its
    // digits when the residual is as large as the other one's compliance makes it.
    motion[i] =
        closed && ck[0] < cn[0] ? normal * (given[i] - overlap[i]) : r[i] - normal * pushed[i];
  }
  return motion;
}

std::vector<double> unilateral_jacobian_column(const PortKernel& kinematic,
                                               const PortKernel& neumann, int count) {
  // Products and inverses of such matrices are such matrices again: C_N C_K^-1 has the column
  // C_K^-1 c_N.
  const Eigen::Map<const Eigen::VectorXd> pushed(neumann.displacement.data(), count);
  const Eigen::VectorXd ratio = solve_toeplitz(kinematic.displacement, pushed);
  std::vector<double> column(ratio.begin(), ratio.end());
  column[0] += 1.0;
  return column;
}

Eigen::MatrixXd parallel_jacobian(const std::vector<const PortKernel*>& kernels,
                                  const std::vector<Substeps>& grids, const Substeps& source,
                                  ForceSupport source_support) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(source.count, source.count);
  for (std::size_t s = 0; s < kernels.size(); ++s) {
    const Eigen::MatrixXd map = neumann_map(*kernels[s], grids[s], source, source_support);
    jacobian +=
        grids[s].same_as(source) ? map : Eigen::MatrixXd(interpolation(source, grids[s]) * map);
  }
  return jacobian;
}

}  // namespace abut
