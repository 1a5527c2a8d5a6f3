#include "subdomain_solver/solve/matrix_sum.hpp"

#include "base/assert.hpp"

namespace abut {

namespace {

/// Where the entries of the whole stand among those of a part, or -1; rows ascend in both.
std::vector<Eigen::Index> places(const SparseMatrix& whole, const SparseMatrix& part) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index column = 0; column < whole.outerSize(); ++column) {
    Eigen::Index at = part.outerIndexPtr()[column];
    const Eigen::Index end = part.outerIndexPtr()[column + 1];
    for (SparseMatrix::InnerIterator entry(whole, column); entry; ++entry) {
      const bool there = at < end && part.innerIndexPtr()[at] == entry.row();
      out.push_back(there ? at++ : -1);
    }
    ABUT_ASSERT(at == end);
  }
  return out;
}

double entry(const SparseMatrix& part, double factor, Eigen::Index place) {
  return place < 0 ? 0.0 : factor * part.valuePtr()[place];
}

}  // namespace

void MatrixSum::find_places(const SparseMatrix& first, const SparseMatrix& second) {
  ABUT_ASSERT(first.isCompressed() && second.isCompressed());
  entries_first_ = first.nonZeros();
  entries_second_ = second.nonZeros();
  sum_ = first + second;
  in_first_ = places(sum_, first);
  in_second_ = places(sum_, second);
}

const SparseMatrix& MatrixSum::of(double a, const SparseMatrix& first, double b,
                                  const SparseMatrix& second) {
  if (entries_first_ != first.nonZeros() || entries_second_ != second.nonZeros())
    find_places(first, second);
  for (std::size_t k = 0; k < in_first_.size(); ++k)
    sum_.valuePtr()[k] = entry(first, a, in_first_[k]) + entry(second, b, in_second_[k]);
  return sum_;
}

SparseMatrix diagonal_matrix(const Vector& entries) {
  SparseMatrix out(entries.size(), entries.size());
  out.reserve(Eigen::VectorXi::Constant(entries.size(), 1));
  for (int i = 0; i < entries.size(); ++i) out.insert(i, i) = entries(i);
  out.makeCompressed();
  return out;
}

}  // namespace abut
