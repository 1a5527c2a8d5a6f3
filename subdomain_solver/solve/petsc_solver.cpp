#include "subdomain_solver/solve/petsc_solver.hpp"

#ifdef ABUT_HAVE_PETSC
#include <petscksp.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#endif

namespace abut {

#ifdef ABUT_HAVE_PETSC

static_assert(sizeof(PetscInt) == sizeof(SparseMatrix::StorageIndex));

namespace {

/// A residual that is not small enough is solved for in another turn, of which each takes away this
/// much: processes that serve know of no tolerance of a body.
constexpr const char* of_one_turn = "1e-7";
constexpr int most_turns = 8;

/// Of a turn that comes to its end at all: PETSc's own 10,000 would be given up too early with
/// unlike materials in one body.
constexpr const char* most_iterations = "100000";

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
  // The same in all processes before they begin, as they must agree on when they have converged.
  for (const auto& [option, value] : {std::pair{"-mpi_ksp_type", "cg"},
                                      {"-mpi_pc_type", "gamg"},
                                      {"-mpi_ksp_rtol", of_one_turn},
                                      {"-mpi_ksp_max_it", most_iterations}})
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
      KSPSetType(solver_, KSPPREONLY);
      PCSetType(preconditioner, PCMPI);
    } else {
      KSPSetType(solver_, KSPCG);
      PCSetType(preconditioner, PCGAMG);
      KSPSetTolerances(solver_, std::atof(of_one_turn), PETSC_DEFAULT, PETSC_DEFAULT,
                       std::atoi(most_iterations));
      KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED);
    }
    return KSPSetFromOptions(solver_) == 0;
  }

  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x.setZero(b.rows());
    if (!b.allFinite()) return false;
    const double size = b.norm();
    if (size == 0.0) return true;
    left_ = b;
    for (int turn = 0; turn < most_turns; ++turn) {
      if (!add_answer(x)) return false;
      left_ = b;
      left_.noalias() -= matrix_ * x;
      const double left = left_.norm();
      if (left <= tolerance_ * size) return true;
      if (!std::isfinite(left)) return false;
    }
    return false;
  }

 private:
  /// To what is left of the right-hand side.
  bool add_answer(Vector& x) {
    more_.setZero(left_.rows());
    Vec right = nullptr, answer = nullptr;
    const auto size = static_cast<PetscInt>(left_.rows());
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, left_.data(), &right);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, more_.data(), &answer);
    const bool failed = KSPSolve(solver_, right, answer) != 0;
    VecDestroy(&right);
    VecDestroy(&answer);
    x += more_;
    return !failed;
  }
  void release() {
    KSPDestroy(&solver_);
    MatDestroy(&shown_);
  }

  double tolerance_;
  SparseMatrix matrix_;
  Vector left_, more_;  // [N] of the right-hand side; to its answer
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
