#include "subdomain_solver/solve/friction_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "subdomain_solver/solve/friction_row.hpp"

namespace abut {

namespace {

constexpr int first_sweeps = 15, most_sweeps = 4000;
/// Of Newton's method; those after which other ways are better, unless they too end.
constexpr int most_newton = 30, first_newton = 10;
/// Of the largest force: changes, and residuals, that are rounding; residuals that are an answer.
constexpr double friction_settled = 1.0e-14, accurate = 1.0e-11;
/// The same of rows that say the same: gaps are differences of places, and differ by rounding.
constexpr double rounded_gaps = 1.0e-8;
/// The same: steps of Newton's method after which the next would be rounding.
constexpr double friction_converged = 1.0e-9;
/// Of the largest compliance: what rows that say the same give way by, each for itself.
constexpr double friction_softness = 1.0e-11;
/// Of the cone's radius: forces nearer to it than this are on it.
constexpr double on_cone = 1.0e-9;
/// Cubes of unknowns that a call factors: some seconds. What takes more is hardly ever found, and
/// whoever asks has other ways.
constexpr double most_cubes = 2.0e10;

using TangentPart = OneRow<>::Tangent;
using PlaneSquare = OneRow<>::PlaneSquare;

double radius(const FrictionRow& row, double normal) {
  return normal > 0.0 ? row.friction * normal : 0.0;
}

/// [N] that close the gaps and stop the slips, each for itself: below parts of them is rounding.
double size_of(const Eigen::MatrixXd& a, const Vector& b) {
  return b.cwiseAbs().cwiseQuotient(a.diagonal()).maxCoeff();
}

/// The nearest force in the disc.
void hold_in_cone(const FrictionRow& row, double normal, Eigen::Ref<Vector> tangent) {
  const double most = radius(row, normal), size = tangent.norm();
  if (size > most) tangent *= size > 0.0 ? most / size : 0.0;
}

/// True: settled.
bool sweep(const Eigen::MatrixXd& a, const Vector& b, std::span<const FrictionRow> rows, int most,
           Vector& z, FrictionBuffers& buffers) {
  Vector& w = buffers.slip;
  w = b;
  w.noalias() += a * z;
  const double size = size_of(a, b);
  for (int k = 0; k < most; ++k) {
    double change = 0.0;
    for (const FrictionRow& row : rows) {
      const Eigen::Index parts = row.parts;
      const Vector old = z.segment(row.first, parts);
      const Vector rate =
          w.segment(row.first, parts) - a.block(row.first, row.first, parts, parts) * old;
      OneRow<>(a.block(row.first, row.first, parts, parts), row)
          .solve(rate(0), rate.tail(parts - 1), z.segment(row.first, parts));
      const Vector moved = z.segment(row.first, parts) - old;
      if (moved.isZero(0.0)) continue;
      w.noalias() += a.middleCols(row.first, parts) * moved;
      change = std::max(change, moved.lpNorm<Eigen::Infinity>());
    }
    if (!z.allFinite()) return false;
    if (change <= friction_settled * std::max(size, z.lpNorm<Eigen::Infinity>())) return true;
  }
  return false;
}

/// Alart and Curnier's equations of the rows that press, made linear at z. The components of open
/// rows are zero.
class Linearised {
 public:
  Linearised(const Eigen::MatrixXd& a, std::span<const FrictionRow> rows, double soft,
             FrictionBuffers& buffers)
      : a_(a), rows_(rows), soft_(soft), b_(buffers) {}

  /// The next iterate; false: there is none.
  [[nodiscard]] bool step(const Vector& b, Vector& z) {
    find_active(b, z);
    const Eigen::Index n = static_cast<Eigen::Index>(b_.active.size());
    if (n == 0) {
      z.setZero();
      return true;
    }
    const auto size = static_cast<double>(n);
    b_.factored += size * size * size;
    if (b_.factored > most_cubes) return false;
    b_.matrix.resize(n, n);
    b_.rest.resize(n);
    Eigen::Index at = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (b_.states[r] == RowState::open) continue;
      fill(rows_[r], b_.states[r], b, z, at);
      at += rows_[r].parts;
    }
    ++b_.solutions;
    b_.factors.compute(b_.matrix);
    b_.factors.solve(b_.rest, b_.step);
    if (!b_.step.allFinite()) return false;
    z.setZero();
    for (Eigen::Index k = 0; k < n; ++k) z(b_.active[k]) = b_.step(k);
    return true;
  }

 private:
  void find_active(const Vector& b, const Vector& z) {
    b_.slip = b;
    b_.slip.noalias() += a_ * z;
    b_.states.assign(rows_.size(), RowState::open);
    b_.active.clear();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const FrictionRow& row = rows_[r];
      const double pushed = z(row.first) - b_.slip(row.first) / a_(row.first, row.first);
      if (pushed <= 0.0) continue;
      b_.states[r] = RowState::sticks;
      for (int p = 0; p < row.parts; ++p) b_.active.push_back(row.first + p);
      if (row.parts == 1) continue;
      if (led(row, z).norm() > row.friction * pushed) b_.states[r] = RowState::slips;
    }
  }
  /// tau - rho w_t
  TangentPart led(const FrictionRow& row, const Vector& z) const {
    const Eigen::Index tangents = row.parts - 1;
    return z.segment(row.first + 1, tangents) - rho(row) * b_.slip.segment(row.first + 1, tangents);
  }
  double rho(const FrictionRow& row) const {
    double sum = 0.0;
    for (int p = 1; p < row.parts; ++p) sum += a_(row.first + p, row.first + p);
    return (row.parts - 1) / sum;
  }
  void fill_rate(Eigen::Index component, const Vector& b, Eigen::Index at) {
    for (std::size_t k = 0; k < b_.active.size(); ++k)
      b_.matrix(at, static_cast<Eigen::Index>(k)) = a_(component, b_.active[k]);
    b_.matrix(at, at) += soft_;
    b_.rest(at) = -b(component);
  }
  void fill(const FrictionRow& row, RowState state, const Vector& b, const Vector& z,
            Eigen::Index at) {
    fill_rate(row.first, b, at);
    if (row.parts == 1) return;
    if (state == RowState::sticks) {
      for (int p = 1; p < row.parts; ++p) fill_rate(row.first + p, b, at + p);
      return;
    }
    // tau = mu lambda e(l), l = tau - rho w_t, e = l/|l|:  what turns e across itself counts,
    // forces along it are lambda's.
    const Eigen::Index tangents = row.parts - 1;
    const TangentPart lead = led(row, z);
    const double size = lead.norm();
    const TangentPart way = lead / size;
    const PlaneSquare across = (PlaneSquare::Identity(tangents, tangents) - way * way.transpose()) *
                               std::min(1.0, radius(row, z(row.first)) / size);
    for (Eigen::Index p = 0; p < tangents; ++p) {
      b_.matrix.row(at + 1 + p).setZero();
      b_.rest(at + 1 + p) = 0.0;
    }
    for (std::size_t k = 0; k < b_.active.size(); ++k) {
      const TangentPart slips = a_.col(b_.active[k]).segment(row.first + 1, tangents) * rho(row);
      b_.matrix.col(static_cast<Eigen::Index>(k)).segment(at + 1, tangents) += across * slips;
    }
    b_.matrix.block(at + 1, at + 1, tangents, tangents) +=
        PlaneSquare::Identity(tangents, tangents) - across;
    b_.matrix.col(at).segment(at + 1, tangents) -= row.friction * way;
    b_.rest.segment(at + 1, tangents) = -(across * (rho(row) * b.segment(row.first + 1, tangents)));
  }

  const Eigen::MatrixXd& a_;
  std::span<const FrictionRow> rows_;
  double soft_;
  FrictionBuffers& b_;
};

/// Into the cone exactly, after iterates that only come near it.
void hold_all(std::span<const FrictionRow> rows, Vector& z) {
  for (const FrictionRow& row : rows) {
    z(row.first) = std::max(0.0, z(row.first));
    hold_in_cone(row, z(row.first), z.segment(row.first + 1, row.parts - 1));
  }
}

bool newton(const Eigen::MatrixXd& a, const Vector& b, std::span<const FrictionRow> rows,
            double soft, Vector& z, FrictionBuffers& buffers, int most_steps = most_newton) {
  Linearised equations(a, rows, soft, buffers);
  buffers.trial = z;
  const double size = size_of(a, b);
  for (int k = 0; k < most_steps; ++k) {
    buffers.best = buffers.trial;
    if (!equations.step(b, buffers.trial)) return false;
    const double change = (buffers.trial - buffers.best).lpNorm<Eigen::Infinity>();
    const bool ended =
        change <= friction_converged * std::max(size, buffers.trial.lpNorm<Eigen::Infinity>());
    // Of bodies much lighter than they are stiff, forces that hold each other go on changing by
    // more; that is rounding where the equations hold to the last digit.
    const double most = !ended ? friction_settled : soft > 0.0 ? 1.0e-8 : accurate;
    buffers.best = buffers.trial;
    hold_all(rows, buffers.best);
    if (friction_residual(a, b, rows, buffers.best) <= most) {
      z = buffers.best;
      return true;
    }
    if (ended) return false;
  }
  return false;
}

/// Newton's method towards where forces already are (proximal points, Rockafellar 1976): rows give
/// way, each for itself, by a part of their own compliance about the forces of the turn before
/// [M.158]. So rows that say the same have one answer. The part falls where a turn does not halve
/// what is left; where that helps no more, what is left is the rounding of gaps.
bool by_proximity(const Eigen::MatrixXd& a, const Vector& b, std::span<const FrictionRow> rows,
                  Vector& z, FrictionBuffers& buffers) {
  constexpr double first = 1.0e-6, most = 0.1, least = 1.0e-10, factor = 10.0;
  constexpr int most_turns = 20, idle_turns = 3;
  Vector& here = buffers.path;
  here = z;
  double part = first, last = std::numeric_limits<double>::infinity();
  int idle = 0;
  for (int turn = 0; turn < most_turns && part <= most; ++turn) {
    buffers.softened = a;
    buffers.softened.diagonal() += part * a.diagonal();
    buffers.shifted = b - part * a.diagonal().cwiseProduct(here);
    if (!newton(buffers.softened, buffers.shifted, rows, 0.0, here, buffers, first_newton)) {
      part *= factor;
      continue;
    }
    const double left = friction_residual(a, b, rows, here);
    if (left > 0.5 * last) {
      ++idle;
      part = std::max(least, part / factor);
    }
    if (left <= accurate || (idle == idle_turns && left <= rounded_gaps)) {
      z = here;
      return true;
    }
    last = left;
  }
  return false;
}

enum class Softened { all, tangents };

/// Newton's method from where it cannot go round in circles: rows give way, each for itself, by a
/// part of the largest compliance that falls to nothing, and the answer for one part begins the
/// next. Where it finds none, the part falls by less.
bool by_softness(const Eigen::MatrixXd& a, const Vector& b, std::span<const FrictionRow> rows,
                 Softened softened, Vector& z, FrictionBuffers& buffers) {
  constexpr double usual = 0.1, slowest = 0.98, least = 1.0e-13;
  constexpr int most_parts = 200;
  const double size = a.diagonal().maxCoeff();
  Vector& here = buffers.path;
  here.setZero(b.size());
  double part = 1.0, last = 0.0, fall = usual;
  for (int k = 0; k < most_parts; ++k) {
    buffers.softened = a;
    for (const FrictionRow& row : rows)
      for (int p = softened == Softened::all ? 0 : 1; p < row.parts; ++p)
        buffers.softened(row.first + p, row.first + p) += part * size;
    if (newton(buffers.softened, b, rows, 0.0, here, buffers)) {
      if (part == 0.0) {
        z = here;
        return true;
      }
      last = part;
      fall = std::max(usual, fall * fall);
    } else {
      fall = std::sqrt(fall);
      if (last == 0.0 || fall > slowest) return false;
    }
    part = last * fall > least ? last * fall : 0.0;
  }
  return false;
}

}  // namespace

void soften_unmoved(std::span<const FrictionRow> rows, Eigen::MatrixXd& a) {
  constexpr double least = 1.0e-12;
  double most = 0.0;
  for (const FrictionRow& row : rows) most = std::max(most, a(row.first, row.first));
  for (const FrictionRow& row : rows)
    if (a(row.first, row.first) < least * most) a(row.first, row.first) += most;
}

void soften_held(std::span<const FrictionRow> rows, Eigen::MatrixXd& a) {
  constexpr double least = 1.0e-9;
  for (const FrictionRow& row : rows) {
    if (row.parts == 1) continue;
    const Eigen::Index t = row.first + 1;
    const double soft = least * a(row.first, row.first);
    double stiffest = a(t, t);
    if (row.parts == 3) {
      const double mean = 0.5 * (a(t, t) + a(t + 1, t + 1));
      const double lean = 0.5 * (a(t, t) - a(t + 1, t + 1));
      stiffest = mean - std::hypot(lean, a(t, t + 1));
    }
    if (stiffest >= soft) continue;
    for (int p = 1; p < row.parts; ++p) a(row.first + p, row.first + p) += soft;
  }
}

double friction_residual(const Eigen::MatrixXd& a, const Vector& b,
                         std::span<const FrictionRow> rows, const Vector& force) {
  const Vector w = b + a * force;
  double most = 0.0, scale = size_of(a, b);
  for (const FrictionRow& row : rows) {
    const Eigen::Index tangents = row.parts - 1;
    const double normal = force(row.first), give = a(row.first, row.first);
    scale = std::max(
        {scale, force.segment(row.first, row.parts).norm(), std::abs(b(row.first)) / give});
    most = std::max(most, std::abs(normal - std::max(0.0, normal - w(row.first) / give)));
    if (tangents == 0) continue;
    Vector led = force.segment(row.first + 1, tangents) -
                 w.segment(row.first + 1, tangents) * tangents /
                     a.block(row.first + 1, row.first + 1, tangents, tangents).trace();
    hold_in_cone(row, normal, led);
    most = std::max(most, (force.segment(row.first + 1, tangents) - led).norm());
  }
  return scale > 0.0 ? most / scale : 0.0;
}

RowState row_state(const FrictionRow& row, const Vector& force) {
  const double normal = force(row.first);
  if (!(normal > 0.0)) return RowState::open;
  if (row.parts == 1) return RowState::slips;
  const double size = force.segment(row.first + 1, row.parts - 1).norm();
  return size < row.friction * normal * (1.0 - on_cone) ? RowState::sticks : RowState::slips;
}

bool friction_forces(const Eigen::MatrixXd& a, const Vector& b, std::span<const FrictionRow> rows,
                     Vector& force, FrictionBuffers& buffers) {
  if (!b.allFinite() || !a.allFinite()) return false;
  buffers.factored = 0.0;
  if (force.size() != b.size()) force.setZero(b.size());
  if (b.size() == 0) return true;
  if (sweep(a, b, rows, first_sweeps, force, buffers)) return true;
  if (!force.allFinite()) force.setZero();
  if (newton(a, b, rows, 0.0, force, buffers, first_newton)) return true;
  if (by_proximity(a, b, rows, force, buffers)) return true;
  const double soft = friction_softness * a.diagonal().maxCoeff();
  if (newton(a, b, rows, soft, force, buffers)) return true;
  for (const Softened softened : {Softened::all, Softened::tangents})
    if (by_softness(a, b, rows, softened, force, buffers)) return true;
  if (sweep(a, b, rows, most_sweeps, force, buffers)) return true;
  return force.allFinite() && friction_residual(a, b, rows, force) <= rounded_gaps;
}

}  // namespace abut
