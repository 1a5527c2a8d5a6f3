#include "subdomain_solver/solve/linear_solver.hpp"

#include <vector>

#include <Eigen/SparseCholesky>

#include "base/assert.hpp"
#include "subdomain_solver/solve/cholmod_solver.hpp"
#include "subdomain_solver/solve/eigen_solver.hpp"
#include "subdomain_solver/solve/multifrontal_solver.hpp"

namespace abut {

namespace {

/// Eigen's LDL^T, digit by digit, that keeps the permuted matrix from factorisation to
/// factorisation and solves in place. As its lists fit onto the stack, neither allocates.
class KeptLdlt : public Eigen::SimplicialLDLT<SparseMatrix> {
 public:
  void factorize(const SparseMatrix& matrix) {
    if (from_.empty()) find_places(matrix);
    ABUT_ASSERT(entries_ == matrix.nonZeros());
    for (std::size_t k = 0; k < from_.size(); ++k)
      permuted_.valuePtr()[k] = matrix.valuePtr()[from_[k]];
    factorize_preordered<true>(permuted_);
  }
  void solve_into(const Vector& b, Vector& x) {
    between_ = m_P * b;
    matrixL().solveInPlace(between_);
    between_ = m_diag.asDiagonal().inverse() * between_;
    matrixU().solveInPlace(between_);
    x = m_Pinv * between_;
  }
  const Vector& pivots() const { return m_diag; }

 private:
  /// Where each entry of the permuted matrix comes from: a matrix of numbers takes its way.
  void find_places(const SparseMatrix& matrix) {
    ABUT_ASSERT(matrix.isCompressed());
    entries_ = matrix.nonZeros();
    SparseMatrix numbered = matrix;
    for (Eigen::Index k = 0; k < entries_; ++k) numbered.valuePtr()[k] = static_cast<double>(k);
    permuted_.resize(matrix.rows(), matrix.cols());
    permuted_.selfadjointView<Eigen::Upper>() =
        numbered.selfadjointView<Eigen::Lower>().twistedBy(m_P);
    for (Eigen::Index k = 0; k < permuted_.nonZeros(); ++k)
      from_.push_back(static_cast<Eigen::Index>(permuted_.valuePtr()[k]));
  }

  SparseMatrix permuted_;           // its upper half
  std::vector<Eigen::Index> from_;  // of its entries
  Eigen::Index entries_ = 0;
  Vector between_;
};

class Ldlt final : public EigenSolver<KeptLdlt> {
 public:
  using EigenSolver::EigenSolver;

 private:
  bool pivots_hold(const Vector& diagonal) const override {
    if (pivots_ == Pivots::definite) return solver_.pivots().minCoeff() > 0.0;
    const auto& place = solver_.permutationP().indices();
    for (Eigen::Index i = 0; i < diagonal.size(); ++i)
      if (!pivot_holds(solver_.pivots()(place(i)), diagonal(i), diagonal.size())) return false;
    return true;
  }
};

/// From so many coordinates on fronts cost less than entries one by one, their ordering included
/// (abut_bench_direct_solvers); below, either takes some milliseconds.
constexpr Eigen::Index large = 1000;

/// Chosen by the first matrix, as all are of one pattern.
class BySize final : public LinearSolver {
 public:
  explicit BySize(Pivots pivots, WorkerThreads* threads = nullptr)
      : pivots_(pivots), threads_(threads) {}

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (chosen_ == nullptr && matrix.rows() < large)
      chosen_ = std::make_unique<Ldlt>(pivots_);
    else if (chosen_ == nullptr)
      chosen_ = make_multifrontal_solver(pivots_, threads_);
    return chosen_->factor(matrix);
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override { return chosen_->solve(b, x); }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    if (b.size() > 0) return chosen_->solve_columns(b, x);
    x = b;  // a matrix without columns has no memory, and solvers would count from there
    return true;
  }

 private:
  Pivots pivots_;
  WorkerThreads* threads_;
  std::unique_ptr<LinearSolver> chosen_;
};

/// CHOLMOD's factors while the matrix is positive definite; past a buckling load, for instance, it
/// is not, and another solver takes over.
class FirstThatFactors final : public LinearSolver {
 public:
  FirstThatFactors(std::unique_ptr<LinearSolver> quick, Pivots pivots, WorkerThreads* threads)
      : quick_(std::move(quick)), general_(pivots, threads) {}

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    definite_ = quick_->factor(matrix);
    return definite_ || general_.factor(matrix);
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    return definite_ ? quick_->solve(b, x) : general_.solve(b, x);
  }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    return definite_ ? quick_->solve_columns(b, x) : general_.solve_columns(b, x);
  }

 private:
  std::unique_ptr<LinearSolver> quick_;
  BySize general_;
  bool definite_ = true;
};

}  // namespace

bool LinearSolver::solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
  x.resize(b.rows(), b.cols());
  Vector one;
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    if (!solve(b.col(k), one)) return false;
    x.col(k) = one;
  }
  return true;
}

std::unique_ptr<LinearSolver> make_own_solver(Pivots pivots) {
  return std::make_unique<BySize>(pivots);
}

std::unique_ptr<LinearSolver> make_direct_solver(Pivots pivots, WorkerThreads* threads) {
  if (std::unique_ptr<LinearSolver> quick = make_cholmod_solver(pivots); quick != nullptr)
    return std::make_unique<FirstThatFactors>(std::move(quick), pivots, threads);
  return std::make_unique<BySize>(pivots, threads);
}

}  // namespace abut
