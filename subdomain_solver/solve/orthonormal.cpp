#include "subdomain_solver/solve/orthonormal.hpp"

#include <limits>

#include "base/dense.hpp"

namespace abut {

void remove_components(const Eigen::MatrixXd& v, const SparseMatrix& mass, Eigen::MatrixXd& x) {
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::MatrixXd momentum = mass * x;
    x -= v * (v.transpose() * momentum);
  }
}

Eigen::MatrixXd orthonormal(Eigen::MatrixXd x, const SparseMatrix& mass, double smallest) {
  // The first pass loses digits where columns are nearly dependent; the second one finds columns
  // that are orthonormal to what it lost, and leaves round-off.
  for (int pass = 0; pass < 2 && x.cols() > 0; ++pass) {
    const Eigen::MatrixXd momentum = mass * x;
    Eigen::MatrixXd gram(x.cols(), x.cols());
    gram.triangularView<Eigen::Lower>() = x.transpose() * momentum;  // the half that is looked at
    const auto [squares, vectors] = symmetric_eigen(gram);
    const double roundoff =
        std::numeric_limits<double>::epsilon() * squares(squares.size() - 1) * double(x.cols());
    const double least = std::max(roundoff, smallest * smallest);
    Eigen::Index first = 0;
    while (first < squares.size() && !(squares(first) > least)) ++first;
    const Eigen::Index kept = squares.size() - first;
    const Vector scale = squares.tail(kept).cwiseSqrt().cwiseInverse();
    x = (x * vectors.rightCols(kept)).eval() * scale.asDiagonal();
    smallest = 0.0;
  }
  return x;
}

}  // namespace abut
