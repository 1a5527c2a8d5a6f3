#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// Solves K x = b for symmetric K. One object serves matrices of one pattern, whose analysis is
/// kept from the first factorisation on.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// False: the matrix is singular, or not a number.
  [[nodiscard]] virtual bool factor(const SparseMatrix& matrix) = 0;
  /// False: not solved to the solver's own tolerance. x is of the size of b.
  [[nodiscard]] virtual bool solve(const Vector& b, Vector& x) = 0;
  /// The same for every column of B; direct solvers pass their factor once for all.
  [[nodiscard]] virtual bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x);
};

/// Which pivots a direct solver takes: of stiffness alone those that are more than round-off, as a
/// body that nothing holds would move without bounds; with inertia any, as it may be many digits
/// less than the stiffness and yet holds the body; or any that are positive, of definite matrices
/// alone.
enum class Pivots { with_digits, every, definite };

/// Direct: L D L^T, by Eigen of small matrices and by fronts of others (docs/adr/0035); by CHOLMOD
/// when the build has it and the matrix is positive definite.
/// `threads` share large fronts, and must outlive the solver; null: alone. Bits are the same.
std::unique_ptr<LinearSolver> make_direct_solver(Pivots pivots = Pivots::with_digits,
                                                 WorkerThreads* threads = nullptr);
/// The same without CHOLMOD in every build: where a step may not allocate.
std::unique_ptr<LinearSolver> make_own_solver(Pivots pivots = Pivots::with_digits);
/// Unknowns of a solid in space above which its factors fill the memory (docs/adr/0035).
constexpr Eigen::Index most_factored = 300'000;

/// What coarser levels of a matrix are made of: motions that cost little energy, rigid ones above
/// all.
struct CoarseMotions {
  std::vector<std::int32_t> nodes;  // (rows) the node of each, ascending from 0 without gaps
  Eigen::MatrixXd motions;          // (rows, motions)
};

/// Conjugate gradients, for positive definite matrices too large to factor, with a multigrid cycle
/// of matrices of as many rows as `motions` has, with incomplete Cholesky factors of others.
/// `tolerance` is of the residual relative to the right-hand side.
std::unique_ptr<LinearSolver> make_conjugate_gradients(double tolerance,
                                                       CoarseMotions motions = {});

}  // namespace abut
