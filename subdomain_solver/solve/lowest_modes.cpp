#include "subdomain_solver/solve/lowest_modes.hpp"

#include <algorithm>
#include <random>

#include "base/dense.hpp"
#include "subdomain_solver/solve/orthonormal.hpp"

namespace abut {

namespace {

/// Vectors of a block: eigenvalues of up to this multiplicity are found.
constexpr Eigen::Index block_size = 8;
/// Up to here the dense problem costs nothing.
constexpr Eigen::Index small_problem = 200;
/// Residual of a mode in parts of its 1/lambda; the eigenvalue's error is of its square.
constexpr double modes_converged = 1.0e-9;
/// Residuals below this part of the largest 1/lambda are round-off.
constexpr double mode_roundoff = 1.0e-13;
/// Growth of the space between two looks at it, each of which costs a dense eigenproblem.
constexpr double growth = 1.15;

Modes dense_modes(const Pencil& pencil, const WantedModes& wanted) {
  const Eigen::MatrixXd stiffness = pencil.stiffness, mass = pencil.mass;
  const EigenPairs eigen = generalized_eigen(stiffness, mass);
  const Vector values = eigen.values.tail(stiffness.rows() - pencil.null);
  const Eigen::Index below =
      std::lower_bound(values.begin(), values.end(), wanted.below) - values.begin();
  const Eigen::Index count = std::min<Eigen::Index>(below, wanted.count);
  return {values.head(count), eigen.vectors.middleCols(pencil.null, count)};
}

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937_64 engine(7);
  Eigen::MatrixXd x(rows, columns);
  for (double& value : x.reshaped()) value = static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5;
  return x;
}

/// Space spanned by the blocks of powers of F M on a random block.
class KrylovSpace {
 public:
  explicit KrylovSpace(const Pencil& pencil) : pencil_(pencil) {
    const Eigen::MatrixXd start = random_columns(pencil.mass.rows(), block_size);
    last_ = orthonormal(pencil.flexibility(pencil.mass * start), pencil.mass, 0.0);
    append();
  }

  Eigen::Index size() const { return size_; }
  bool exhausted() const { return last_.cols() == 0; }

  void expand() {
    Eigen::MatrixXd image = pencil_.flexibility(pencil_.mass * last_);
    const Eigen::MatrixXd momentum = pencil_.mass * image;
    const Eigen::Index from = size_ - last_.cols();
    projected_.conservativeResize(size_, size_);
    projected_.rightCols(last_.cols()) = space().transpose() * momentum;
    projected_.bottomRows(last_.cols()) = projected_.rightCols(last_.cols()).transpose().eval();
    largest_ = std::max(largest_, projected_.diagonal().maxCoeff());
    remove_components(space(), pencil_.mass, image);
    last_ = orthonormal(image, pencil_.mass, mode_roundoff * largest_);
    const Eigen::MatrixXd beyond = pencil_.mass * image;
    coupling_ = last_.transpose() * beyond;
    coupled_ = from;
    append();
  }

  /// The wanted among the lowest modes that have converged. They are `enough` when the next one
  /// has converged too: none is missing below it.
  Modes modes(const WantedModes& wanted, bool& enough) const {
    const Eigen::Index m = projected_.rows();
    const EigenPairs eigen = symmetric_eigen(projected_);
    const Vector inverse = eigen.values.reverse();
    const Eigen::MatrixXd parts = eigen.vectors.rowwise().reverse();
    const Eigen::MatrixXd residuals = coupling_ * parts.bottomRows(m - coupled_);
    Eigen::Index sound = 0, count = 0;
    const auto settled = [&](Eigen::Index k) {
      return exhausted() || residuals.col(k).norm() <=
                                std::max(modes_converged * inverse(k), mode_roundoff * largest_);
    };
    while (sound < m && settled(sound)) ++sound;
    while (count < sound && count < wanted.count && inverse(count) * wanted.below > 1.0) ++count;
    enough = count < sound || exhausted();
    return {inverse.head(count).cwiseInverse(), space().leftCols(m) * parts.leftCols(count)};
  }

 private:
  Eigen::MatrixXd::ConstColsBlockXpr space() const { return vectors_.leftCols(size_); }

  void append() {
    const Eigen::Index need = size_ + last_.cols();
    if (vectors_.cols() < need) vectors_.conservativeResize(pencil_.mass.rows(), 2 * need);
    vectors_.middleCols(size_, last_.cols()) = last_;
    size_ = need;
  }

  const Pencil& pencil_;
  Eigen::MatrixXd vectors_, last_;  // orthonormal; the block that came last
  Eigen::MatrixXd projected_;       // V^T M F M V of all but the last block
  Eigen::MatrixXd coupling_;        // of the last block with the one before
  Eigen::Index size_ = 0, coupled_ = 0;
  double largest_ = 0.0;  // 1/lambda
};

}  // namespace

Modes lowest_modes(const Pencil& pencil, const WantedModes& wanted) {
  const Eigen::Index n = pencil.mass.rows(), all = n - pencil.null;
  if (wanted.count <= 0 || all <= 0) return {Vector(), Eigen::MatrixXd(n, 0)};
  const bool most = wanted.count < std::numeric_limits<int>::max() && 3 * wanted.count >= n;
  if (n <= small_problem || most) return dense_modes(pencil, wanted);
  KrylovSpace space(pencil);
  double next = static_cast<double>(2 * block_size);
  while (space.size() < n / 2) {
    space.expand();
    if (static_cast<double>(space.size()) < next && !space.exhausted()) continue;
    next = growth * static_cast<double>(space.size());
    bool enough = false;
    const Modes found = space.modes(wanted, enough);
    if (enough) return found;
    if (space.exhausted()) break;
  }
  return dense_modes(pencil, wanted);
}

}  // namespace abut
