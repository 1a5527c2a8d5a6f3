#include "subdomain_solver/solve/cholmod_solver.hpp"

#ifdef ABUT_HAVE_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

namespace abut {

#ifdef ABUT_HAVE_CHOLMOD

namespace {

class Cholmod final : public LinearSolver {
 public:
  Cholmod() { solver_.cholmod().print = 0; }  // a failure is a value, not a line on the terminal

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (!analysed_) solver_.analyzePattern(matrix);
    analysed_ = true;
    solver_.factorize(matrix);
    return solver_.info() == Eigen::Success;
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x = solver_.solve(b);
    return x.allFinite();
  }

 private:
  Eigen::CholmodSupernodalLLT<SparseMatrix> solver_;
  bool analysed_ = false;
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_solver() { return std::make_unique<Cholmod>(); }

#else

std::unique_ptr<LinearSolver> make_cholmod_solver() { return nullptr; }

#endif

}  // namespace abut
