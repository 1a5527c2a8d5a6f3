#pragma once

#include <memory>

#include <Eigen/Core>

namespace abut {

/// Decompositions of dense matrices of any size. Eigen computes them; each file that names one of
/// its own compiles all of it again, for ten seconds, so that they are named in dense.cpp alone.
/// What a function returns has the bits of Eigen's own answer.

/// Eigenvalues, ascending, and their vectors in columns.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Of a symmetric matrix, whose lower half is read.
EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);
/// Of a x = lambda b x, both symmetric and b positive definite.
EigenPairs generalized_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// matrix = u diag(values) v^T, values descending; u and v square and orthogonal.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd u, v;
};
enum class SingularVectors { none, right, both };  ///< what is left out has no rows
SingularValues singular_values(const Eigen::MatrixXd& matrix, SingularVectors vectors);

/// Q of the matrix's QR factors: as many columns as the matrix has.
Eigen::MatrixXd orthogonal_columns(const Eigen::MatrixXd& matrix);
/// Order of columns in which QR with pivots takes them: the first are the most independent.
Eigen::VectorXi pivot_order(const Eigen::MatrixXd& matrix);
/// x for which matrix x is nearest to right, by QR with pivots.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// The same of columns that are independent, without pivots.
Eigen::VectorXd qr_solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// Of least size; singular values below `threshold` of the largest pivot count as none.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix, double threshold);

/// Of a square, regular matrix.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);
double determinant_of(const Eigen::MatrixXd& matrix);

/// Whether a symmetric matrix has Cholesky factors, which take its place: no memory is asked for.
[[nodiscard]] bool factor_definite(Eigen::MatrixXd& matrix);
/// x of matrix x = right, the matrix symmetric and not indefinite (LDL^T with pivots).
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// x of matrix x = right, the matrix square and regular (LU with partial pivots).
Eigen::MatrixXd solve_square(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::VectorXd solve_square(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

enum class Factoring { lu, cholesky, ldlt };  ///< partial pivots; of definite; pivoted, symmetric

/// A matrix's factors, kept to solve with again and again.
class DenseFactors {
 public:
  explicit DenseFactors(Factoring kind);
  DenseFactors(DenseFactors&& other) noexcept;
  DenseFactors& operator=(DenseFactors&& other) noexcept;
  ~DenseFactors();

  /// False: a matrix for Cholesky factors is not definite. Memory of an earlier one is used again.
  bool compute(const Eigen::MatrixXd& matrix);
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  void solve(const Eigen::VectorXd& right, Eigen::VectorXd& x) const;  ///< not in place
  /// Of LU factors the diagonal of U; of LDL^T D, in the order in which pivots were taken.
  Eigen::VectorXd pivots() const;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace abut
