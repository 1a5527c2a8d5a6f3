#pragma once

#include <span>
#include <vector>

#include "base/dense.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

/// A row of contact among the components of its problem: its normal, then its tangents.
struct FrictionRow {
  Eigen::Index first = 0;  // component of the normal
  int parts = 1;           // 1: without friction; 2 in the plane, 3 in space
  double friction = 0.0;   // Coulomb's coefficient
};

enum class RowState : char { open, sticks, slips };

/// Memory that calls use again; its contents mean nothing between them, but for `solutions`.
struct FrictionBuffers {
  std::vector<RowState> states;
  std::vector<Eigen::Index> active;
  Eigen::MatrixXd matrix, part, softened;
  Vector slip, step, rest, trial, best, path, shifted;
  DenseFactors factors{Factoring::lu};
  std::size_t solutions = 0;  // of linear equations by all calls so far
  double factored = 0.0;      // in this call, cubes of unknowns
};

/// The forces z = (lambda, tau) of rows with Coulomb's friction, w = b + A z:
///   0 <= lambda _|_ w_n >= 0,   |tau| <= mu lambda,   w_t = 0 or tau = -mu lambda w_t/|w_t|
/// with A [m/N] (components) symmetric and positive definite, b [m] gaps and slips without the
/// forces. Begins with `force`, as far as it fits, and leaves the answer there, in the cone
/// exactly. Row after row (Gauss and Seidel) until it is known which rows stick, then Newton's
/// method on Alart and Curnier's equations (1991); where it finds no end, as of rows that say the
/// same, the same about the forces of the turn before [M.158], by way of rows that give way less
/// and less, and rows again. False: none came to an end.
[[nodiscard]] bool friction_forces(const Eigen::MatrixXd& a, const Vector& b,
                                   std::span<const FrictionRow> rows, Vector& force,
                                   FrictionBuffers& buffers);

/// Gives rows that no force opens, as between nodes that supports hold on both sides, the softness
/// of the one that gives way most: what is left of their weights by rounding, 1e-17 of those of
/// others, would ask for any force. Less than 1e-12 of the softest is none.
void soften_unmoved(std::span<const FrictionRow> rows, Eigen::MatrixXd& a);

/// Gives rows whose tangents (or one of them) give way by nothing, as before a support that holds
/// them, a softness of 1e-9 of their normal's compliance: what slips there anyway rubs all the
/// same.
void soften_held(std::span<const FrictionRow> rows, Eigen::MatrixXd& a);

/// Relative to the largest force, or to what would close gaps and stop slips: how far forces are
/// from what friction_forces asks for.
double friction_residual(const Eigen::MatrixXd& a, const Vector& b,
                         std::span<const FrictionRow> rows, const Vector& force);

/// What a row does under forces that solve the problem.
RowState row_state(const FrictionRow& row, const Vector& force);

}  // namespace abut
