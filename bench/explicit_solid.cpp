/// Cost of explicit solids: whole steps (force and update) of boxes of hex8, per element and step,
/// full and one point, neo-Hookean and linear; the share of the force; the force on each
/// instruction set; the force of J2 plasticity by batches and cell by cell, and of all laws,
/// formulations and elements; beside it what the machine's memory allows for the bytes moved, in
/// the same run.
///
///   abut_bench_explicit_solid [EDGE OF THE LARGE BOX] [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"

namespace abut {
namespace {

struct Seconds {
  double wall = 0.0, processor = 0.0;  // processor: of all threads
};

Seconds seconds(const std::function<void()>& work) {
  const auto began = std::chrono::steady_clock::now();
  const std::clock_t ticks = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(),
          static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC};
}

/// The least of some repeats: other work on the machine only adds. One thread is measured by the
/// processor's time, which other work adds less to; several by the wall's.
double least(int repeats, int threads, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const Seconds s = seconds(work);
    best = std::min(best, threads == 1 ? s.processor : s.wall);
  }
  return best;
}

struct Setting {
  std::array<int, 3> elements;
  bool one_point, linear;
  int threads;
};

struct Cost {
  double step = 0.0, force = 0.0;  // [ns] per element and step
};

const Moduli rubber{1.0e9 / 1.5, 0.4e9};

Cost cost(const Setting& s, int repeats) {
  BoxMesh box;
  for (std::size_t d = 0; d < 3; ++d) box.lengths[d] = 1.0e-3 * s.elements[d];
  box.elements = s.elements;
  std::unique_ptr<Material> law = std::make_unique<NeoHookean>(rubber, 1000.0);
  if (s.linear) law = std::make_unique<LinearElastic>(rubber, 1000.0);
  FeOptions options;
  options.formulation = s.one_point ? Formulation::one_point : Formulation::full;
  options.batched = true;
  options.threads = s.threads;
  FeModel model(generate(box, "bench"), std::move(law), options);
  Problem problem;
  problem.model = &model;
  ExplicitDynamics scheme(problem);
  Motion motion;
  motion.q.assign(index(model.dofs()), 0.0);
  motion.v = motion.q;
  for (std::size_t i = 0; i < motion.v.size(); i += 3)  // waves along x
    motion.v[i] = 10.0 * (model.mesh().points[i] - 0.5 * box.lengths[0]) / box.lengths[0];
  if (scheme.begin(motion, 0.0)) std::abort();
  const int count = s.elements[0] * s.elements[1] * s.elements[2];
  const int steps = std::max(1, 400'000 / count);
  double time = 0.0;
  const double dt = 2.0e-7;
  const double whole = least(repeats, s.threads, [&] {
    for (int k = 0; k < steps; ++k, time += dt)
      if (scheme.step(motion, time, dt)) std::abort();
  });
  ModelResponse response;
  const double force = least(repeats, s.threads, [&] {
    for (int k = 0; k < steps; ++k)
      if (!model.evaluate(motion.q, {}, Model::Want::force, response)) std::abort();
  });
  const double each = 1.0e9 / (double(steps) * count);
  return {whole * each, force * each};
}

/// The force alone, on each instruction set that the machine has, and the memory that it takes.
void run_instructions(int repeats) {
  BoxMesh box;
  box.elements = {64, 32, 40};
  box.lengths = {0.064, 0.032, 0.04};
  const Mesh mesh = generate(box, "bench");
  const int count = mesh.cell_count();
  const NeoHookean law(rubber, 1000.0);
  std::vector<double> q(mesh.points.size()), force(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = 1.0e-5 * static_cast<double>(i % 17);
  for (const KernelTable* kernels : batched_kernels()) {
    fmt::print("{:>9} {:>8}", count, kernels->instructions);
    for (const bool one_point : {false, true}) {
      BatchedCells cells(
          mesh, law,
          {one_point ? Formulation::one_point : Formulation::full, 0.05, 1.0, 1, kernels});
      CellEnergies energies;
      const double wall = least(repeats, 1, [&] {
        if (!cells.evaluate(q, {}, force, energies)) std::abort();
      });
      fmt::print("   {} point(s): {:.1f} ns, {} B an element", one_point ? 1 : 8,
                 wall * 1.0e9 / count, cells.bytes() / index(count));
    }
    fmt::print("\n");
  }
}

/// The force of J2 plasticity where no point yields and where every one does, by batches and cell
/// by cell in turns: ns per element and evaluation.
void run_plastic(int repeats) {
  BoxMesh box;
  box.elements = {32, 16, 20};
  box.lengths = {0.032, 0.016, 0.02};
  const Moduli steel{1.67e11, 7.7e10};
  const Hardening hardening{4.0e8, 1.0e9, {}};
  fmt::print("{:>16} {:>8} {:>9} {:>13} {:>7}   J2 force, ns per element\n", "formulation", "state",
             "batched", "cell by cell", "ratio");
  for (const auto& [formulation, name] : {std::pair{Formulation::full, "full"},
                                          {Formulation::mean_dilatation, "mean_dilatation"},
                                          {Formulation::one_point, "one_point"}}) {
    for (const bool yields : {false, true}) {
      std::array<double, 2> cost{};
      for (const bool batched : {false, true}) {
        FeOptions options;
        options.formulation = formulation;
        options.batched = batched;
        FeModel model(generate(box, "bench"),
                      std::make_unique<J2Plasticity>(steel, hardening, 7800.0), options);
        std::vector<double> q(index(model.dofs()), 0.0), history(model.history_size(), 0.0);
        for (std::size_t i = 0; i < q.size(); ++i)  // a stretch, and each cell's own part
          q[i] = (i % 3 == 0 ? model.mesh().points[i] : 0.0) * (yields ? 8.0e-3 : 4.0e-4) +
                 1.0e-8 * static_cast<double>(i * i % 97);
        ModelResponse response;
        const double best = least(repeats, 1, [&] {
          if (!model.evaluate(q, history, Model::Want::force, response)) std::abort();
        });
        cost[batched] = best * 1.0e9 / model.mesh().cell_count();
        const auto flown = [&](std::size_t k) { return response.history[k] > 0.0; };
        for (std::size_t k = 6; k < history.size(); k += 7)
          if (flown(k) != yields) std::abort();
      }
      fmt::print("{:>16} {:>8} {:>9.1f} {:>13.1f} {:>7.1f}\n", name, yields ? "yields" : "elastic",
                 cost[1], cost[0], cost[0] / cost[1]);
    }
  }
}

std::unique_ptr<Material> law_of(const std::string& name) {
  if (name == "linear") return std::make_unique<LinearElastic>(rubber, 1000.0);
  if (name == "Saint Venant") return std::make_unique<SaintVenantKirchhoff>(rubber, 1000.0);
  if (name == "neo-Hookean") return std::make_unique<NeoHookean>(rubber, 1000.0);
  if (name == "Mooney-Rivlin")
    return std::make_unique<MooneyRivlin>(MooneyRivlinParameters{1.5e8, 5.0e7, 6.7e8, 1000.0});
  if (name == "Hencky") return std::make_unique<Hencky>(rubber, 1000.0);
  return std::make_unique<J2Plasticity>(rubber, Hardening{4.0e8, 1.0e9, {}}, 1000.0);
}

/// The force of every law and of every element, ns per element, where all strains are different;
/// whether it is computed eight cells at a time.
void run_laws(int repeats) {
  fmt::print("{:>14} {:>8} {:>16} {:>10} {:>10}   force, ns per element\n", "law", "element",
             "formulation", "batched", "force");
  const auto one = [repeats](const std::string& law, const std::string& element,
                             Formulation formulation, const char* words) {
    BoxMesh box;
    box.elements = {24, 16, 20};
    box.lengths = {0.024, 0.016, 0.02};
    box.element = element;
    FeOptions options;
    options.formulation = formulation;
    std::unique_ptr<Material> material = law_of(law);
    const Mesh mesh = generate(box, "bench");
    options.batched = BatchedCells::can(mesh, *material, formulation);
    FeModel model(mesh, std::move(material), options);
    std::vector<double> q(index(model.dofs()), 0.0), history(model.history_size(), 0.0);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = 1.0e-7 * static_cast<double>(i * i % 97);
    ModelResponse response;
    const double best = least(repeats, 1, [&] {
      if (!model.evaluate(q, history, Model::Want::force, response)) std::abort();
    });
    fmt::print("{:>14} {:>8} {:>16} {:>10} {:>10.1f}\n", law, element, words,
               options.batched ? "yes" : "no", best * 1.0e9 / model.mesh().cell_count());
  };
  for (const char* law :
       {"linear", "Saint Venant", "neo-Hookean", "Mooney-Rivlin", "Hencky", "J2"}) {
    one(law, "hex8", Formulation::full, "full");
    one(law, "hex8", Formulation::one_point, "one_point");
    if (std::string(law) != "linear")
      one(law, "hex8", Formulation::mean_dilatation, "mean_dilatation");
    for (const char* element : {"tet4", "tet10", "hex20"})
      one(law, element, Formulation::full, "full");
  }
}

/// The stable step of a box at rest, whose cells are equal, and of one deformed everywhere.
void run_stable_step(int repeats) {
  BoxMesh box;
  box.elements = {20, 20, 20};
  box.lengths = {0.02, 0.02, 0.02};
  FeModel model(generate(box, "bench"), std::make_unique<NeoHookean>(rubber, 1000.0), {});
  std::vector<double> q(index(model.dofs()), 0.0);
  const double count = model.mesh().cell_count();
  double sum = 0.0;
  const double rest = least(repeats, 1, [&] { sum += stable_step(model, q, {}); });
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = 1.0e-8 * static_cast<double>(i * i % 9973);
  const double moved = least(repeats, 1, [&] { sum += stable_step(model, q, {}); });
  if (!(sum > 0.0)) std::abort();
  fmt::print("stable step, ns per element: equal cells {:.0f}, all different {:.0f}\n",
             rest * 1.0e9 / count, moved * 1.0e9 / count);
}

/// Nanoseconds per element for what a step must move at least, the vectors of motion: 11 reads and
/// writes of each of three coordinates, 264 bytes an element.
double streaming_limit(int elements, int repeats) {
  const std::size_t n = index(elements) * 3;
  std::vector<double> q(n, 1.0), v(n, 2.0), a(n, 3.0), force(n, 4.0), mass(n, 5.0), next(n, 0.0);
  const double wall = least(repeats, 1, [&] {
    for (std::size_t i = 0; i < n; ++i) next[i] = q[i] + 1.0e-9 * (v[i] + 1.0e-9 * a[i]);
    for (std::size_t i = 0; i < n; ++i) force[i] = next[i];
    for (std::size_t i = 0; i < n; ++i) {
      const double before = a[i];
      a[i] = force[i] * mass[i];
      v[i] += 1.0e-9 * (before + a[i]);
    }
    q.swap(next);
  });
  return wall * 1.0e9 / elements;
}

void run(int edge, int repeats) {
  fmt::print("explicit hex8, whole steps, least of {}; instructions: {}\n", repeats,
             batched_kernels().front()->instructions);
  run_instructions(repeats);
  run_plastic(repeats);
  run_laws(repeats);
  run_stable_step(repeats);
  fmt::print("{:>9} {:>8} {:>10} {:>7} {:>8} {:>8} {:>9}   ns per element-step\n", "elements",
             "law", "points", "threads", "step", "force", "streaming");
  for (const std::array<int, 3>& elements :
       {std::array<int, 3>{64, 32, 40}, std::array<int, 3>{edge, edge, edge}}) {
    const int count = elements[0] * elements[1] * elements[2];
    for (const bool linear : {false, true}) {
      for (const bool one_point : {false, true}) {
        for (const int threads : {1, 2}) {
          const Cost c = cost({elements, one_point, linear, threads}, repeats);
          fmt::print("{:>9} {:>8} {:>10} {:>7} {:>8.1f} {:>8.1f} {:>9.1f}\n", count,
                     linear ? "linear" : "neo", one_point ? 1 : 8, threads, c.step, c.force,
                     streaming_limit(count, repeats));
        }
      }
    }
  }
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int edge = argc > 1 ? std::max(1, std::atoi(argv[1])) : 100;
  abut::run(edge, argc > 2 ? std::max(1, std::atoi(argv[2])) : 5);
  return 0;
}
