/// Cost of implicit solids: tangent assembly, factor and solve of a clamped linear elastic cube of
/// hex8, beside the bare library on the same matrix, and what the parts take of memory. 32 elements
/// per edge are 1e5 degrees of freedom.
///
///   abut_bench_implicit_solid [ELEMENTS_PER_EDGE [REPEATS]]

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#ifdef ABUT_HAVE_CHOLMOD
#include <cholmod.h>
#else
#include <Eigen/SparseCholesky>
#endif

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {
namespace {

double seconds(const std::function<void()>& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Bytes in use.
double allocated() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

/// A linear law that does not say so: its model assembles at every call.
class Assembled final : public Material {
 public:
  double density() const override { return law_.density(); }
  Moduli moduli() const override { return law_.moduli(); }
  bool evaluate(const Matrix3& f, std::span<const double> before, std::span<double> after,
                Need want, PointResponse& out) const override {
    return law_.evaluate(f, before, after, want, out);
  }

 private:
  LinearElastic law_{Moduli{1.25, 0.5}, 1.0};
};

/// Seconds of one factorisation, its analysis included, and of one solve; bytes of the factor.
struct Cost {
  double factor = 0.0, solve = 0.0, memory = 0.0;
};

Cost cost_of_ours(const SparseMatrix& k, const Vector& b, Vector& x) {
  const double before = allocated();
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  const auto must = [](bool done) {
    if (!done) std::abort();
  };
  Cost t;
  t.factor = seconds([&] { must(solver->factor(k)); });
  t.memory = allocated() - before;
  t.solve = seconds([&] { must(solver->solve(b, x)); });
  return t;
}

#ifdef ABUT_HAVE_CHOLMOD

Cost cost_of_bare(const SparseMatrix& k, const Vector& b, Vector& x) {
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
  SparseMatrix copy = k;
  cholmod_sparse a = {};
  a.nrow = a.ncol = index(k.rows());
  a.nzmax = index(k.nonZeros());
  a.p = copy.outerIndexPtr();
  a.i = copy.innerIndexPtr();
  a.x = copy.valuePtr();
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  Vector right = b;
  cholmod_dense rhs = {};
  rhs.nrow = rhs.nzmax = rhs.d = a.nrow;
  rhs.ncol = 1;
  rhs.x = right.data();
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  cholmod_factor* factor = nullptr;
  Cost t;
  t.factor = seconds([&] {
    factor = cholmod_analyze(&a, &common);
    cholmod_factorize(&a, factor, &common);
  });
  t.solve = seconds([&] {
    cholmod_dense* out = cholmod_solve(CHOLMOD_A, factor, &rhs, &common);
    x = Eigen::Map<const Vector>(static_cast<const double*>(out->x), k.rows());
    cholmod_free_dense(&out, &common);
  });
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  return t;
}
constexpr const char* library = "CHOLMOD";

#else

Cost cost_of_bare(const SparseMatrix& k, const Vector& b, Vector& x) {
  Eigen::SimplicialLDLT<SparseMatrix> bare;
  Cost t;
  t.factor = seconds([&] { bare.compute(k); });
  t.solve = seconds([&] { x = bare.solve(b); });
  return t;
}
constexpr const char* library = "Eigen's LDL^T";

#endif

Mesh cube(int elements) {
  BoxMesh box;
  box.lengths = {1.0, 1.0, 1.0};
  box.elements = {elements, elements, elements};
  return generate(box, "bench");
}

/// Seconds of one tangent assembly of a law, and the tangent.
double assembly(std::unique_ptr<const Material> law, Formulation formulation, int elements,
                int repeats, ModelResponse& response) {
  FeModel model(cube(elements), std::move(law), {Plane::strain, formulation, 1.0});
  const std::vector<double> q(index(model.dofs()), 0.0);
  std::vector<double> samples;
  for (int r = 0; r <= repeats; ++r) {
    const double wall = seconds([&] {
      if (!model.evaluate(q, {}, Model::Want::tangent, response)) std::abort();
    });
    if (r > 0) samples.push_back(wall);
  }
  return median(samples);
}

void run(int elements, int repeats) {
  const double cells = double(elements) * elements * elements;
  const double empty = allocated();
  ModelResponse response;
  FeModel model(cube(elements), std::make_unique<LinearElastic>(Moduli{1.25, 0.5}, 1.0), {});
  const std::vector<double> rest(index(model.dofs()), 0.0);
  if (!model.evaluate(rest, {}, Model::Want::tangent, response)) std::abort();
  response = {};
  model.mass();
  const double held = allocated() - empty;
  fmt::print("clamped cube, {0} x {0} x {0} hex8, {1} degrees of freedom, {2}\n", elements,
             model.dofs(), library);
  fmt::print("memory of the linear model, stiffness and mass: {:.2f} kB per degree of freedom\n",
             held / model.dofs() / 1e3);

  const double linear =
      assembly(std::make_unique<Assembled>(), Formulation::full, elements, repeats, response);
  const auto report = [cells](const char* what, double wall) {
    fmt::print("{:<42} {:>9.3f} s {:>8.2f} us per cell\n", what, wall, wall / cells * 1e6);
  };
  report("tangent, linear elastic", linear);
  ModelResponse other;
  const Moduli moduli{1.25, 0.5};
  report("tangent, neo-Hookean", assembly(std::make_unique<NeoHookean>(moduli, 1.0),
                                          Formulation::full, elements, repeats, other));
  report("tangent, neo-Hookean, mean dilatation",
         assembly(std::make_unique<NeoHookean>(moduli, 1.0), Formulation::mean_dilatation, elements,
                  repeats, other));

  std::vector<Prescribed> supports;
  for (std::int32_t node : model.mesh().nodes_of("left")) {
    for (int i = 0; i < 3; ++i) supports.push_back({3 * node + i, [](double) { return 0.0; }});
  }
  FreeCoordinates free(model.dofs(), supports);
  SparseMatrix k;
  free.extract(response.tangent, k);
  response = other = {};
  const Vector b = Vector::Ones(k.rows());
  Vector ours, bare;
  std::vector<double> factor, solve, ratio;
  double memory = 0.0;
  for (int r = 0; r < repeats; ++r) {
    const Cost mine = cost_of_ours(k, b, ours), theirs = cost_of_bare(k, b, bare);
    factor.push_back(mine.factor);
    solve.push_back(mine.solve);
    ratio.push_back((mine.factor + mine.solve) / (theirs.factor + theirs.solve));
    memory = mine.memory;
  }
  fmt::print("factor {:.3f} s, solve {:.3f} s\n", median(factor), median(solve));
  fmt::print("tangent, linear elastic / factor   {:>7.3f}   (at most 0.2)\n",
             linear / median(factor));
  fmt::print("factor and solve / bare library    {:>7.3f}   (at most 1.2; {:.3f} to {:.3f})\n",
             median(ratio), *std::min_element(ratio.begin(), ratio.end()),
             *std::max_element(ratio.begin(), ratio.end()));
  fmt::print("difference of the two solutions    {:>7.1e}   (relative)\n",
             (ours - bare).norm() / bare.norm());
  fmt::print("memory of matrix and factor: {:.2f} and {:.2f} kB per degree of freedom\n",
             static_cast<double>(k.nonZeros()) * 12.0 / model.dofs() / 1e3,
             memory / model.dofs() / 1e3);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  abut::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 20,
            argc > 2 ? std::max(1, std::atoi(argv[2])) : 5);
  return 0;
}
