/// Cost of a surface without mass in an explicit step, nothing near it: of one side of a block and
/// of a cube's whole skin, linear and neo-Hookean. Processor time of one thread, medians; the whole
/// step beside that of the same body without the layer, in turns.
///
///   abut_bench_massless_layer [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
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

/// A block of cells of 1 mm that breathes.
struct Body {
  Body(const std::array<int, 3>& elements, bool linear, const std::string& side) {
    BoxMesh box;
    for (std::size_t d = 0; d < 3; ++d) box.lengths[d] = 1.0e-3 * elements[d];
    box.elements = elements;
    const Moduli rubber{1.0e9 / 1.5, 0.4e9};
    std::unique_ptr<Material> law = std::make_unique<NeoHookean>(rubber, 1000.0);
    if (linear) law = std::make_unique<LinearElastic>(rubber, 1000.0);
    FeOptions options;
    options.batched = true;
    model = std::make_unique<FeModel>(generate(box, "bench"), std::move(law), options);
    if (!side.empty()) {
      nodes = model->mesh().nodes_of(side);
      model->make_massless(nodes, {});
    }
    problem.model = model.get();
    scheme = std::make_unique<ExplicitDynamics>(problem);
    layer = std::make_unique<MasslessLayer>(problem);
    motion.q.assign(index(model->dofs()), 0.0);
    motion.v = motion.q;
    for (std::size_t i = 0; i < motion.v.size(); i += 3)
      motion.v[i] = 10.0 * (model->mesh().points[i] - 0.5 * box.lengths[0]) / box.lengths[0];
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
  static constexpr double dt = 1.0e-7;
};

void run(const char* words, const std::array<int, 3>& elements, bool linear, const char* side,
         int repeats) {
  Body with(elements, linear, side), without(elements, linear, "");
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
  fmt::print("{:<24} {:>8} {:>8} {:>8} {:>9.2f} {:>9.2f} {:>9.2f}\n", words,
             linear ? "linear" : "neo", cells, with.nodes.size(), median(alone) * 1.0e6 / nodes,
             median(bare) * 1.0e9 / cells / 1000.0, median(ratio));
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  fmt::print("{:<24} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "law", "cells", "surface", "layer",
             "step", "step with");
  fmt::print("{:<24} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "", "", "nodes", "us/node",
             "us/cell", "over bare");
  for (const bool linear : {true, false}) {
    for (const int n : {10, 30, 60, 120})
      abut::run("one side, 8 cells deep", {n, n, 8}, linear, "front", repeats);
    for (const int n : {10, 20, 40})
      abut::run("a cube's skin", {n, n, n}, linear, "boundary", repeats);
  }
  return 0;
}
