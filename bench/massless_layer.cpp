/// Cost of a surface without mass in an explicit step, nothing near it: of one side of a block and
/// of a cube's whole skin, linear, neo-Hookean and of J2 plasticity. Waves of some ten cells run
/// through the bodies. Processor time of one thread, medians; the whole step beside that of the
/// same body without the layer, in turns.
///
///   abut_bench_massless_layer [REPEATS [LAW]]

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/massless_layer.hpp"

namespace abut {
namespace {

double seconds(int count, const std::function<void()>& work) {
  const std::clock_t began = std::clock();
  for (int k = 0; k < count; ++k) work();
  return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / count;
}

double median(std::vector<double> samples) {
  std::ranges::nth_element(samples, samples.begin() + std::ssize(samples) / 2);
  return samples[samples.size() / 2];
}

std::unique_ptr<Material> make_law(const std::string& name) {
  const Moduli rubber{1.0e9 / 1.5, 0.4e9};
  const Hardening hardening{1.0e7, 1.0e8, {}};
  if (name == "linear") return std::make_unique<LinearElastic>(rubber, 1000.0);
  if (name == "J2") return std::make_unique<J2Plasticity>(rubber, hardening, 1000.0);
  return std::make_unique<NeoHookean>(rubber, 1000.0);
}

/// A block of cells of 1 mm that breathes and bends: strains of about a hundredth.
struct Body {
  Body(const std::array<int, 3>& elements, const std::string& law, const std::string& side) {
    BoxMesh box;
    for (std::size_t d = 0; d < 3; ++d) box.lengths[d] = 1.0e-3 * elements[d];
    box.elements = elements;
    FeOptions options;
    options.batched = true;
    model = std::make_unique<FeModel>(generate(box, "bench"), make_law(law), options);
    if (!side.empty()) {
      nodes = model->mesh().nodes_of(side);
      std::vector<int> dofs;
      for (const std::int32_t node : nodes)
        for (int i = 0; i < 3; ++i) dofs.push_back(node * 3 + i);
      std::ranges::sort(dofs);
      model->make_massless(dofs, {});
    }
    problem.model = model.get();
    scheme = std::make_unique<ExplicitDynamics>(problem);
    layer = std::make_unique<MasslessLayer>(problem);
    motion.q.assign(index(model->dofs()), 0.0);
    motion.v = motion.q;
    for (std::size_t i = 0; i < motion.v.size(); ++i) {
      const std::size_t node = i - i % 3, other = node + (i + 1) % 3;
      const double wave =
          std::sin(600.0 * model->mesh().points[other] + static_cast<double>(i % 3));
      motion.v[i] = 10.0 * (model->mesh().points[i] / box.lengths[i % 3] - 0.5) + 5.0 * wave;
    }
    if (scheme->begin(motion, 0.0)) std::abort();
  }
  void step() {
    if (scheme->step(motion, time, dt)) std::abort();
    time += dt;
  }
  void settle() {
    q = motion.q;
    for (const int dof : layer->dofs()) q[dof] -= dt * motion.v[dof];
    if (layer->settle(time, q, motion.history, {}, nullptr)) std::abort();
  }

  std::vector<std::int32_t> nodes;
  std::unique_ptr<FeModel> model;
  Problem problem;
  std::unique_ptr<ExplicitDynamics> scheme;
  std::unique_ptr<MasslessLayer> layer;
  Motion motion;
  std::vector<double> q;
  double time = 0.0;
  static constexpr double dt = 4.0e-7;
};

void run(const char* words, const std::array<int, 3>& elements, const char* law, const char* side,
         int repeats) {
  Body with(elements, law, side), without(elements, law, "");
  const int cells = elements[0] * elements[1] * elements[2];
  const int steps = std::max(1, 100'000 / cells);
  with.settle();  // factors
  std::vector<double> alone, whole, bare, ratio;
  for (int r = 0; r < repeats; ++r) {
    alone.push_back(seconds(steps, [&] { with.settle(); }));
    whole.push_back(seconds(steps, [&] { with.step(); }));
    bare.push_back(seconds(steps, [&] { without.step(); }));
    ratio.push_back(whole.back() / bare.back());
  }
  const double nodes = static_cast<double>(with.nodes.size());
  fmt::print("{:<24} {:>12} {:>8} {:>8} {:>9.2f} {:>9.2f} {:>9.2f}\n", words, law, cells,
             with.nodes.size(), median(alone) * 1.0e6 / nodes,
             median(bare) * 1.0e9 / cells / 1000.0, median(ratio));
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  fmt::print("{:<24} {:>12} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "law", "cells", "surface",
             "layer", "step", "step with");
  fmt::print("{:<24} {:>12} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "", "", "nodes", "us/node",
             "us/cell", "over bare");
  for (const char* law : {"linear", "neo-Hookean", "J2"}) {
    if (argc > 2 && std::string(law) != argv[2]) continue;
    for (const int n : {10, 30, 60, 120})
      abut::run("one side, 8 cells deep", {n, n, 8}, law, "front", repeats);
    for (const int n : {10, 20, 40})
      abut::run("a cube's skin", {n, n, n}, law, "boundary", repeats);
  }
  return 0;
}
