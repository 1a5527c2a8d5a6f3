/// Linear solvers side by side: analysis, factor, solve and memory of linear elastic bodies clamped
/// at one end, cubes, a slender bar and a sheet. Beside the product's own, direct (docs/adr/0035)
/// and by multigrid (docs/adr/0052), Eigen's, MUMPS and SuperLU where their packages are installed,
/// CHOLMOD in a build with it. The last two and MUMPS are as fast as the machine's BLAS. Cubes
/// above what factors take are solved by multigrid alone.
///
///   abut_bench_direct_solvers [LARGEST_BODY [SOLVERS]]     of unknowns; own alone, or all

#include <fmt/format.h>
#include <malloc.h>
#include <ctime>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/MetisSupport>
#include <Eigen/SparseCholesky>
#ifdef ABUT_HAVE_CHOLMOD
#include <Eigen/CholmodSupport>
#endif
#ifdef ABUT_BENCH_MUMPS
#include <dmumps_c.h>
#endif
#ifdef ABUT_BENCH_SUPERLU
#include <Eigen/SuperLUSupport>
#endif

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/make/linear_choice.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/multifrontal_solver.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {
namespace {

/// [s] of the processor, all threads.
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1.0e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
double seconds(Work&& work) {
  const double began = processor_time();
  work();
  return processor_time() - began;
}

/// Bytes in use.
double allocated() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

struct Cost {
  double analyse = 0.0, factor = 0.0, solve = 0.0;  // [s]
  double memory = 0.0;                              // [B]
};

void report(const char* name, const Cost& cost, const SparseMatrix& k, const Vector& b,
            const Vector& x) {
  fmt::print("  {:<22} {:>8.3f} {:>9.4f} {:>8.4f} {:>9.1f} {:>9.1e}\n", name, cost.analyse,
             cost.factor, cost.solve, cost.memory / 1e6, (k * x - b).norm() / b.norm());
  std::cout.flush();
}

/// Quick ones several times, and the least counts; analysis is what the first factorisation takes
/// beside.
void measure(const char* name, std::unique_ptr<LinearSolver> solver, const SparseMatrix& k,
             const Vector& b) {
  const auto must = [](bool done) {
    if (!done) std::abort();
  };
  const double before = allocated();
  const double first = seconds([&] { must(solver->factor(k)); });
  Cost cost{0.0, seconds([&] { must(solver->factor(k)); }), 0.0, allocated() - before};
  for (int again = 0; again < 4 && cost.factor < 0.5; ++again)
    cost.factor = std::min(cost.factor, seconds([&] { must(solver->factor(k)); }));
  cost.analyse = std::max(0.0, first - cost.factor);
  Vector x;
  cost.solve = seconds([&] { must(solver->solve(b, x)); });
  for (int again = 0; again < 4; ++again)
    cost.solve = std::min(cost.solve, seconds([&] { must(solver->solve(b, x)); }));
  report(name, cost, k, b, x);
}

template <class Solver>
void measure_eigen(const char* name, const SparseMatrix& k, const Vector& b) {
  const double before = allocated();
  Solver solver;
  Cost cost;
  cost.analyse = seconds([&] { solver.analyzePattern(k); });
  cost.factor = seconds([&] { solver.factorize(k); });
  cost.memory = allocated() - before;
  Vector x;
  cost.solve = seconds([&] { x = solver.solve(b); });
  report(name, cost, k, b, x);
}

#ifdef ABUT_BENCH_SUPERLU
/// In an order of METIS, without exchanges.
void measure_superlu(const SparseMatrix& k, const Vector& b) {
  const double before = allocated();
  Eigen::SuperLU<SparseMatrix> solver;
  solver.options().ColPerm = NATURAL;
  solver.options().SymmetricMode = YES;
  solver.options().DiagPivotThresh = 0.0;
  solver.options().Equil = NO;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  SparseMatrix permuted;
  Cost cost;
  cost.analyse = seconds([&] {
    Eigen::MetisOrdering<int>()(k, order);
    permuted = order * k * order.inverse();
    solver.analyzePattern(permuted);
  });
  cost.factor = seconds([&] { solver.factorize(permuted); });
  cost.memory = allocated() - before;
  Vector x;
  cost.solve = seconds([&] { x = solver.solve(b); });
  report("SuperLU, METIS", cost, permuted, b, x);
}
#endif

#ifdef ABUT_BENCH_MUMPS
void measure_mumps(const SparseMatrix& k, const Vector& b) {
  std::vector<int> row, column;
  std::vector<double> value;
  for (int j = 0; j < k.cols(); ++j) {
    for (SparseMatrix::InnerIterator at(k, j); at; ++at) {
      if (at.row() < j) continue;
      row.push_back(static_cast<int>(at.row()) + 1);
      column.push_back(j + 1);
      value.push_back(at.value());
    }
  }
  DMUMPS_STRUC_C mumps = {};
  const auto call = [&mumps](int job) {
    mumps.job = job;
    return seconds([&mumps] { dmumps_c(&mumps); });
  };
  mumps.par = 1;
  mumps.sym = 2;                 // symmetric, not always definite
  mumps.comm_fortran = -987654;  // all processes
  call(-1);
  for (const int stream : {0, 1, 2}) mumps.icntl[stream] = -1;
  mumps.icntl[3] = 0;
  mumps.icntl[6] = 3;  // SCOTCH
  mumps.n = static_cast<int>(k.rows());
  mumps.nnz = static_cast<std::int64_t>(value.size());
  mumps.irn = row.data();
  mumps.jcn = column.data();
  mumps.a = value.data();
  const double before = allocated();
  Cost cost;
  cost.analyse = call(1);
  cost.factor = call(2);
  cost.memory = allocated() - before;
  Vector x = b;
  mumps.rhs = x.data();
  mumps.nrhs = 1;
  mumps.lrhs = mumps.n;
  cost.solve = call(3);
  report("MUMPS, SCOTCH", cost, k, b, x);
  call(-2);
}
#endif

/// Of a body clamped on the left.
struct System {
  SparseMatrix stiffness;
  CoarseMotions motions;
};

System system_of(const Mesh& mesh) {
  FeModel model(Mesh(mesh), std::make_unique<LinearElastic>(Moduli{1.25, 0.5}, 1.0), {});
  ModelResponse response;
  const std::vector<double> rest(index(model.dofs()), 0.0);
  if (!model.evaluate(rest, {}, Model::Want::tangent, response)) std::abort();
  std::vector<Prescribed> supports;
  for (const std::int32_t node : mesh.nodes_of("left"))
    for (int i = 0; i < mesh.dim; ++i)
      supports.push_back({mesh.dim * node + i, [](double) { return 0.0; }});
  std::ranges::sort(supports, {}, &Prescribed::dof);
  std::vector<int> held;
  for (const Prescribed& p : supports) held.push_back(p.dof);
  System out{{}, coarse_motions(model, held)};
  FreeCoordinates(model.dofs(), supports).extract(response.tangent, out.stiffness);
  return out;
}

Mesh box(const std::array<int, 3>& cells) {
  BoxMesh out;
  out.elements = cells;
  for (std::size_t i = 0; i < 3; ++i) out.lengths[i] = cells[i];
  return generate(out, "bench");
}

Mesh sheet(int edge) {
  RectangleMesh out;
  out.elements = {edge, edge};
  out.lengths = {1.0, 1.0};
  return generate(out, "bench");
}

void compare(const char* body, const Mesh& mesh, int largest, bool all) {
  if (mesh.dim * mesh.node_count() > largest) return;
  const System system = system_of(mesh);
  const SparseMatrix& k = system.stiffness;
  fmt::print("{}, {} unknowns, {} entries\n", body, k.rows(), k.nonZeros());
  const Vector b = Vector::LinSpaced(k.rows(), -1.0, 2.0);
  measure("abut, multigrid", make_conjugate_gradients(1.0e-10, system.motions), k, b);
  if (k.rows() > most_factored) return;
  measure("abut, fronts", make_multifrontal_solver(Pivots::with_digits), k, b);
  if (!all) return;
#ifdef ABUT_HAVE_CHOLMOD
  measure_eigen<Eigen::CholmodSupernodalLLT<SparseMatrix>>("CHOLMOD", k, b);
#endif
#ifdef ABUT_BENCH_MUMPS
  measure_mumps(k, b);
#endif
#ifdef ABUT_BENCH_SUPERLU
  measure_superlu(k, b);
#endif
  using Dissected = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::MetisOrdering<int>>;
  measure_eigen<Dissected>("Eigen LDL^T, METIS", k, b);
  measure_eigen<Eigen::SimplicialLDLT<SparseMatrix>>("Eigen LDL^T, AMD", k, b);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 30'000;
  const bool all = argc < 3 || std::string(argv[2]) != "own";
  fmt::print("{:<24} {:>8} {:>9} {:>8} {:>9} {:>9}\n", "processor time [s]", "analyse", "factor",
             "solve", "MB", "residual");
  using namespace abut;
  compare("cube 5", box({5, 5, 5}), largest, all);
  compare("cube 9", box({9, 9, 9}), largest, all);
  compare("cube 14", box({14, 14, 14}), largest, all);
  compare("cube 20", box({20, 20, 20}), largest, all);
  compare("cube 32", box({32, 32, 32}), largest, all);
  compare("cube 50", box({50, 50, 50}), largest, all);
  compare("cube 70", box({70, 70, 70}), largest, all);
  compare("bar 50 x 5 x 5", box({50, 5, 5}), largest, all);
  compare("row 100 x 1 x 1", box({100, 1, 1}), largest, all);
  compare("sheet 20 x 20", sheet(20), largest, all);
  compare("sheet 60 x 60", sheet(60), largest, all);
  return 0;
}
