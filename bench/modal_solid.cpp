/// Cost of modal bodies: the reduction of a clamped beam of hex8 in units of one factorisation of
/// its mesh, and a step by modes in units of the same step by finite elements.
///
///   abut_bench_modal_solid [ELEMENTS_OVER_THE_HEIGHT [MODES [REPEATS]]]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/modal/modal_basis.hpp"
#include "subdomain_solver/modal/modal_model.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/implicit_dynamics.hpp"

namespace abut {
namespace {

/// Processor time: all of this runs in one thread, on machines that others may use.
double seconds(const std::function<void()>& work) {
  const std::clock_t began = std::clock();
  work();
  return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
}

struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
};

Spread repeated(int repeats, const std::function<double()>& sample) {
  std::vector<double> values;
  for (int r = 0; r < repeats; ++r) values.push_back(sample());
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.front(), values.back()};
}

/// A beam five times as long as high, clamped at its left end.
struct Beam {
  FeModel model;
  Problem problem;
  std::vector<int> held, tip;

  static Mesh mesh(int elements) {
    BoxMesh box;
    box.lengths = {5.0, 1.0, 1.0};
    box.elements = {5 * elements, elements, elements};
    return generate(box, "bench");
  }

  Beam(int elements, bool batched)
      : model(mesh(elements), std::make_unique<LinearElastic>(Moduli{1.25, 0.5}, 1.0),
              {Plane::strain, Formulation::full, 1.0, 0.05, batched}) {
    problem.model = &model;
    for (std::int32_t node : model.mesh().nodes_of("left")) {
      for (int i = 0; i < 3; ++i) {
        held.push_back(3 * node + i);
        problem.supports.push_back({held.back(), [](double) { return 0.0; }});
      }
    }
    for (std::int32_t node : model.mesh().nodes_of("right")) {
      for (int i = 0; i < 3; ++i) tip.push_back(3 * node + i);
    }
  }
};

/// Seconds of one factorisation of the free part of the stiffness, its analysis included.
double factorisation(Beam& beam) {
  ModelResponse rest;
  const std::vector<double> q(index(beam.model.dofs()), 0.0);
  if (!beam.model.evaluate(q, {}, Model::Want::tangent, rest)) std::abort();
  SparseMatrix k;
  FreeCoordinates(beam.model.dofs(), beam.problem.supports).extract(rest.tangent, k);
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  return seconds([&] {
    if (!solver->factor(k)) std::abort();
  });
}

/// Seconds of one step from a motion that takes part in everything, the first ones left out.
double step_time(Integrator& run, int coordinates, double dt, int steps) {
  Motion motion;
  motion.q.assign(index(coordinates), 0.0);
  motion.v.assign(motion.q.size(), 1.0e-3);
  if (run.begin(motion, 0.0)) std::abort();
  int done = 0;
  const auto advance = [&](int count) {
    for (int k = 0; k < count; ++k, ++done) {
      if (run.step(motion, done * dt, dt)) std::abort();
    }
  };
  advance(3);
  return seconds([&] { advance(steps); }) / steps;
}

void report(const char* scheme, const Spread& fe, const Spread& modal) {
  fmt::print(
      "{:<20} a step by finite elements {:.0f} us ({:.0f} to {:.0f}), by modes {:.2f} us "
      "({:.2f} to {:.2f}), ratio {:.4f}\n",
      scheme, 1e6 * fe.median, 1e6 * fe.low, 1e6 * fe.high, 1e6 * modal.median, 1e6 * modal.low,
      1e6 * modal.high, modal.median / fe.median);
}

/// Prints what the reduction costs; returns the one with the port.
ModalBasis reductions(Beam& beam, MassForm form, const WantedModes& wanted, int repeats) {
  const Spread factor = repeated(repeats, [&beam] { return factorisation(beam); });
  fmt::print("one factorisation {:.3f} s ({:.3f} to {:.3f})\n", factor.median, factor.low,
             factor.high);
  ModalBasis basis;
  for (const bool port : {false, true}) {
    const Spread wall = repeated(repeats, [&] {
      return seconds([&] {
        basis = reduce(beam.model, beam.held, port ? beam.tip : std::vector<int>(), form, wanted,
                       "bench");
      });
    });
    fmt::print(
        "reduction, {} modes, {} coordinates of the port {:.3f} s ({:.3f} to {:.3f}): {:.1f} "
        "factorisations\n",
        wanted.count, basis.port_coordinates, wall.median, wall.low, wall.high,
        wall.median / factor.median);
  }
  return basis;
}

void run(int elements, int modes, int repeats) {
  Beam beam(elements, false), batched(elements, true);
  fmt::print("clamped beam, {0} x {1} x {1} hex8, {2} coordinates, mass lumped\n", 5 * elements,
             elements, beam.model.dofs());
  WantedModes wanted;
  wanted.count = modes;
  ModalModel model(reductions(beam, MassForm::lumped, wanted, repeats).frequencies);
  Problem problem;
  problem.model = &model;
  const auto step_of = [repeats](Integrator& run, const Problem& p, double dt, int steps) {
    return repeated(repeats, [&] { return step_time(run, p.model->dofs(), dt, steps); });
  };
  const ImplicitDynamics::Options newmark{AlphaWeights::newmark(0.25, 0.5), MassForm::lumped, {}};
  ImplicitDynamics one(beam.problem, newmark, make_direct_solver());
  ImplicitDynamics other(problem, newmark, make_direct_solver());
  report("newmark", step_of(one, beam.problem, 0.1, 10), step_of(other, problem, 0.1, 2000));
  ExplicitDynamics quick(batched.problem), quicker(problem);
  const double limit = stable_step(batched.model), wide = model.stable_step();
  report("central difference", step_of(quick, batched.problem, 0.9 * limit, 50),
         step_of(quicker, problem, 0.9 * wide, 20000));
  fmt::print("stable step by modes over that by finite elements: {:.2f}\n", wide / limit);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const auto argument = [&](int k, int fallback) {
    return argc > k ? std::atoi(argv[k]) : fallback;
  };
  abut::run(argument(1, 8), argument(2, 50), argument(3, 5));
  return 0;
}
