#include "subdomain_solver/solve/cholmod_solver.hpp"

#ifdef ABUT_HAVE_CHOLMOD
#include <Eigen/CholmodSupport>

#include "subdomain_solver/solve/eigen_solver.hpp"
#endif

namespace abut {

#ifdef ABUT_HAVE_CHOLMOD

namespace {

/// Shows the pivots: squares of the diagonal of L, in the order of the elimination. Factors and
/// answers are new memory of the library every time.
class Supernodal : public Eigen::CholmodSupernodalLLT<SparseMatrix> {
 public:
  void solve_into(const Vector& b, Vector& x) const { x = solve(b); }

  /// Calls `see` for each, with the row of the matrix that it belongs to.
  template <class See>
  void visit_pivots(See see) const {
    const cholmod_factor& factor = *m_cholmodFactor;
    const auto list = [](const void* numbers) { return static_cast<const StorageIndex*>(numbers); };
    const StorageIndex *first = list(factor.super), *rows = list(factor.pi);
    const StorageIndex *values = list(factor.px), *row = list(factor.Perm);
    const double* x = static_cast<const double*>(factor.x);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
      const StorageIndex height = rows[s + 1] - rows[s];
      for (StorageIndex k = 0; k < first[s + 1] - first[s]; ++k) {
        const double root = x[values[s] + k * (height + 1)];
        see(root * root, row[first[s] + k]);
      }
    }
  }
};

class Cholmod final : public EigenSolver<Supernodal> {
 public:
  explicit Cholmod(Pivots pivots) : EigenSolver(pivots) {
    solver_.cholmod().print = 0;  // a failure is a value, not a line on the terminal
  }

 private:
  bool pivots_hold(const Vector& diagonal) const override {
    if (pivots_ == Pivots::definite) return true;  // as there are factors
    bool all = true;
    solver_.visit_pivots([&all, &diagonal](double pivot, Eigen::Index row) {
      all = all && pivot_holds(pivot, diagonal(row), diagonal.size());
    });
    return all;
  }
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_solver(Pivots pivots) {
  return std::make_unique<Cholmod>(pivots);
}

#else

std::unique_ptr<LinearSolver> make_cholmod_solver(Pivots) { return nullptr; }

#endif

}  // namespace abut
