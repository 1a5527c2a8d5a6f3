#include "base/dense.hpp"

#include <variant>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "base/assert.hpp"

namespace abut {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

}  // namespace

EigenPairs symmetric_eigen(const Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Vector symmetric_eigenvalues(const Matrix& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

EigenPairs generalized_eigen(const Matrix& a, const Matrix& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> eigen(a, b);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Vector generalized_eigenvalues(const Matrix& a, const Matrix& b) {
  constexpr int alone = Eigen::EigenvaluesOnly | Eigen::Ax_lBx;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(a, b, alone).eigenvalues();
}

SingularValues singular_values(const Matrix& matrix, SingularVectors vectors) {
  const unsigned wanted = vectors == SingularVectors::none ? 0
                          : vectors == SingularVectors::right
                              ? Eigen::ComputeFullV
                              : Eigen::ComputeFullU | Eigen::ComputeFullV;
  const Eigen::JacobiSVD<Matrix> parts(matrix, wanted);
  SingularValues out{parts.singularValues(), {}, {}};
  if (parts.computeU()) out.u = parts.matrixU();
  if (parts.computeV()) out.v = parts.matrixV();
  return out;
}

Matrix orthogonal_columns(const Matrix& matrix) {
  const Eigen::HouseholderQR<Matrix> qr(matrix);
  Matrix out = Matrix::Identity(matrix.rows(), matrix.cols());
  out.applyOnTheLeft(qr.householderQ());
  return out;
}

Eigen::VectorXi pivot_order(const Matrix& matrix) {
  return Eigen::ColPivHouseholderQR<Matrix>(matrix).colsPermutation().indices();
}

Matrix least_squares(const Matrix& matrix, const Matrix& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Vector least_squares(const Matrix& matrix, const Vector& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Vector qr_solve(const Matrix& matrix, const Vector& right) {
  return matrix.householderQr().solve(right);
}

Matrix pseudo_inverse(const Matrix& matrix, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
  factors.setThreshold(threshold);
  return factors.compute(matrix).pseudoInverse();
}

Matrix inverse_of(const Matrix& matrix) { return matrix.inverse(); }

double determinant_of(const Matrix& matrix) { return matrix.determinant(); }

bool factor_definite(Matrix& matrix) {
  return Eigen::LLT<Eigen::Ref<Matrix>>(matrix).info() == Eigen::Success;
}

Matrix solve_symmetric(const Matrix& matrix, const Matrix& right) {
  return matrix.ldlt().solve(right);
}

Vector solve_symmetric(const Matrix& matrix, const Vector& right) {
  return matrix.ldlt().solve(right);
}

Matrix solve_square(const Matrix& matrix, const Matrix& right) {
  return matrix.partialPivLu().solve(right);
}

Vector solve_square(const Matrix& matrix, const Vector& right) {
  return matrix.partialPivLu().solve(right);
}

struct DenseFactors::Kept {
  std::variant<Eigen::PartialPivLU<Matrix>, Eigen::LLT<Matrix>, Eigen::LDLT<Matrix>> factors;
};

DenseFactors::DenseFactors(Factoring kind) : kept_(std::make_unique<Kept>()) {
  if (kind == Factoring::cholesky) kept_->factors.emplace<1>();
  if (kind == Factoring::ldlt) kept_->factors.emplace<2>();
}

DenseFactors::DenseFactors(DenseFactors&& other) noexcept = default;
DenseFactors& DenseFactors::operator=(DenseFactors&& other) noexcept = default;
DenseFactors::~DenseFactors() = default;

bool DenseFactors::compute(const Matrix& matrix) {
  std::visit([&](auto& factors) { factors.compute(matrix); }, kept_->factors);
  const auto* cholesky = std::get_if<1>(&kept_->factors);
  return cholesky == nullptr || cholesky->info() == Eigen::Success;
}

Vector DenseFactors::solve(const Vector& right) const {
  return std::visit([&](auto& factors) -> Vector { return factors.solve(right); }, kept_->factors);
}

Matrix DenseFactors::solve(const Matrix& right) const {
  return std::visit([&](auto& factors) -> Matrix { return factors.solve(right); }, kept_->factors);
}

void DenseFactors::solve(const Vector& right, Vector& x) const {
  std::visit([&](auto& factors) { x = factors.solve(right); }, kept_->factors);
}

Vector DenseFactors::pivots() const {
  if (const auto* ldlt = std::get_if<2>(&kept_->factors)) return ldlt->vectorD();
  const auto* lu = std::get_if<0>(&kept_->factors);
  ABUT_ASSERT(lu != nullptr);
  return lu->matrixLU().diagonal();
}

}  // namespace abut
