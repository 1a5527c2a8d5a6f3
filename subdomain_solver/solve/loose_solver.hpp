#pragma once

#include <memory>

#include "base/dense.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// The loose motion along which a pressed body falls the fastest.
struct Falling {
  double stiffness = 0.0;  // [N/m] with which it falls; 0: it stands
  Vector along;            // (k) of length 1
};

/// Solves K x = b for the stiffness of a body that its supports leave rigid motions R: of b what no
/// stiffness can answer is left out, and of x what R would add  [M.112]:
///
///   K x + C m = b,  C^T x = 0,   C = R / n,  R^T C = 1
///
/// or, where they are stabilised by a stiffness s, C^T x = m / s  [M.143].
///
/// The inner solver factors K with springs at as many coordinates as there are motions; what these
/// do wrong is taken back exactly.
class LooseSolver final : public LinearSolver {
 public:
  /// `motions`: R (n, k), columns of length sqrt(n) at right angles; n: coordinates of K. `give`:
  /// 1 / s [m/N]; 0: nothing gives way.
  LooseSolver(std::unique_ptr<LinearSolver> inner, Eigen::MatrixXd motions, double give = 0.0);

  /// Whether contact is solved for with the factors to come: springs that a pressed body overcomes
  /// are stiffened then.
  void hold_up(bool wanted) { holds_up_ = wanted; }
  /// Springs of a step are that stiff [N/m] or, where that is less, as stiff as s.
  void stiffen(double stiffness) { stiffer_ = stiffness; }
  /// Of the last factors, where contact was solved for with them.
  const Falling& falling() const { return falling_; }
  [[nodiscard]] bool factor(const SparseMatrix& matrix) override;
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override;
  /// The same for C^T x - m / s = a (k); and m (k).
  [[nodiscard]] bool solve(const Vector& b, const Vector& a, Vector& x, Vector& m);

 private:
  double give_of(const Eigen::MatrixXd& rigid);

  std::unique_ptr<LinearSolver> inner_;
  Eigen::MatrixXd motions_;
  double give_;
  double stiffer_ = 0.0;  // [N/m]
  bool holds_up_ = false;
  Falling falling_;
  std::vector<int> held_;  // coordinates with springs, which determine R
  SparseMatrix sprung_;
  Eigen::MatrixXd answers_;  // (n, 2k) of the inner solver: to the springs' forces, to C
  DenseFactors closing_{Factoring::lu};  // (2k, 2k)
  Vector values_, none_, left_;
};

}  // namespace abut
