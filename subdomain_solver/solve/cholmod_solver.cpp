#include "subdomain_solver/solve/cholmod_solver.hpp"

#ifdef ABUT_HAVE_CHOLMOD
#include <Eigen/CholmodSupport>

#include "subdomain_solver/solve/eigen_solver.hpp"
#endif

namespace abut {

#ifdef ABUT_HAVE_CHOLMOD

namespace {

class Cholmod final : public EigenSolver<Eigen::CholmodSupernodalLLT<SparseMatrix>> {
 public:
  Cholmod() { solver_.cholmod().print = 0; }  // a failure is a value, not a line on the terminal
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_solver() { return std::make_unique<Cholmod>(); }

#else

std::unique_ptr<LinearSolver> make_cholmod_solver() { return nullptr; }

#endif

}  // namespace abut
