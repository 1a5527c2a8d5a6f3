#include "subdomain_solver/solve/petsc_solver.hpp"

#ifdef ABUT_HAVE_PETSC
#include <petscksp.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#endif

namespace abut {

#ifdef ABUT_HAVE_PETSC

static_assert(sizeof(PetscInt) == sizeof(SparseMatrix::StorageIndex));

namespace {

/// Of what PETSc was asked for: the residual is computed anew, and rounded.
constexpr double most_left = 10.0;

/// Of a system that is solved at all: PETSc's own 10,000 would be given up too early in contact
/// with bodies of unlike materials.
constexpr int most_iterations = 100'000;

/// Processes that mpirun has started, by what Open MPI and MPICH tell them.
int processes_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* count = std::getenv(name); count != nullptr) return std::atoi(count);
  return 1;
}

bool several() { return processes_started() > 1; }

/// Once per process, at its first need; the library ends with the program.
void begin(const char* program) {
  PetscBool begun = PETSC_FALSE;
  PetscInitialized(&begun);
  if (begun == PETSC_TRUE) return;
  PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
  if (several()) PetscOptionsSetValue(nullptr, "-mpi_linear_solver_server", nullptr);
  for (const auto& [option, value] : {std::pair{"-mpi_ksp_type", "cg"}, {"-mpi_pc_type", "gamg"}})
    PetscOptionsSetValue(nullptr, option, value);
  std::string name = program;
  char* words[] = {name.data(), nullptr};
  char** list = words;
  int count = 1;  // the command line is the program's
  PetscInitialize(&count, &list, nullptr, nullptr);
  (void)std::atexit([] { PetscFinalize(); });
}

class Petsc final : public LinearSolver {
 public:
  explicit Petsc(double tolerance) : tolerance_(tolerance) { begin("abut"); }
  ~Petsc() override { release(); }
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    release();
    matrix_ = matrix;  // whose arrays PETSc reads: of a symmetric matrix columns are rows
    matrix_.makeCompressed();
    for (Eigen::Index k = 0; k < matrix_.nonZeros(); ++k)
      if (!std::isfinite(matrix_.valuePtr()[k])) return false;
    if (matrix_.rows() == 0) return true;  // all coordinates are prescribed
    const auto size = static_cast<PetscInt>(matrix_.rows());
    MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size, matrix_.outerIndexPtr(),
                              matrix_.innerIndexPtr(), matrix_.valuePtr(), &shown_);
    MatSetOption(shown_, MAT_SPD, PETSC_TRUE);
    KSPCreate(PETSC_COMM_SELF, &solver_);
    KSPSetOperators(solver_, shown_, shown_);
    PC preconditioner = nullptr;
    KSPGetPC(solver_, &preconditioner);
    if (several()) {  // whose processes iterate by themselves
      PetscOptionsSetValue(nullptr, "-mpi_ksp_rtol", fmt::format("{}", tolerance_).c_str());
      KSPSetType(solver_, KSPPREONLY);
      PCSetType(preconditioner, PCMPI);
    } else {
      KSPSetType(solver_, KSPCG);
      PCSetType(preconditioner, PCGAMG);
      KSPSetTolerances(solver_, tolerance_, PETSC_DEFAULT, PETSC_DEFAULT, most_iterations);
      KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED);
    }
    return KSPSetFromOptions(solver_) == 0;
  }

  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x.setZero(b.rows());
    if (!b.allFinite()) return false;
    const double size = b.norm();
    if (size == 0.0) return true;
    Vec right = nullptr, left = nullptr;
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(b.rows()), b.data(), &right);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(x.rows()), x.data(), &left);
    const bool failed = KSPSolve(solver_, right, left) != 0;
    VecDestroy(&right);
    VecDestroy(&left);
    if (failed || !x.allFinite()) return false;
    left_ = b;
    left_.noalias() -= matrix_ * x;
    return left_.norm() <= most_left * tolerance_ * size;
  }

 private:
  void release() {
    KSPDestroy(&solver_);
    MatDestroy(&shown_);
  }

  double tolerance_;
  SparseMatrix matrix_;
  Vector left_;  // [N] of the right-hand side
  Mat shown_ = nullptr;
  KSP solver_ = nullptr;
};

}  // namespace

bool has_petsc() { return true; }

std::unique_ptr<LinearSolver> make_petsc_solver(double tolerance) {
  return std::make_unique<Petsc>(tolerance);
}

void join_processes(const char* program) {
  if (several()) begin(program);
}

#else

bool has_petsc() { return false; }
std::unique_ptr<LinearSolver> make_petsc_solver(double) { return nullptr; }
void join_processes(const char*) {}

#endif

}  // namespace abut
