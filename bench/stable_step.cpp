/// Cost of holding explicit steps below the stable limit: one bound on the highest frequency
/// [M.58], in whole steps of the same body, and its share where it is asked for at the shortest
/// interval; how far it is above the eigenvalues. Boxes of hex8, neo-Hookean: equal cells at rest,
/// distorted cells at rest, and a body that is compressed unevenly. One thread.
///
///   abut_bench_stable_step [EDGE OF THE BOX] [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/stable_steps.hpp"

namespace abut {
namespace {

/// The least processor time of some repeats: other work on the machine only adds.
double least(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const std::clock_t ticks = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC);
  }
  return best;
}

const Moduli rubber{1.0e9 / 1.5, 0.4e9};

struct Setting {
  const char* words;
  Formulation formulation;
  double distortion, compression;  // of an edge; of the body's length, uneven
  bool plastic;
};

/// A cube of unit cells whose inner nodes are moved.
Mesh mesh_of(int edge, double distortion) {
  BoxMesh box;
  box.elements = {edge, edge, edge};
  box.lengths = {double(edge), double(edge), double(edge)};
  Mesh mesh = generate(box, "bench");
  std::mt19937_64 engine(7);
  for (double& x : mesh.points) {
    const double draw = static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5;
    if (x > 0.5 && x < edge - 0.5) x += 2.0 * distortion * draw;
  }
  return mesh;
}

void run(const Setting& s, int edge, int repeats) {
  std::unique_ptr<Material> law = std::make_unique<NeoHookean>(rubber, 1000.0);
  if (s.plastic) law = std::make_unique<J2Plasticity>(rubber, Hardening{1.0e7, 1.0e8, {}}, 1000.0);
  FeOptions options;
  options.formulation = s.formulation;
  options.batched = true;
  FeModel model(mesh_of(edge, s.distortion), std::move(law), options);
  Problem problem;
  problem.model = &model;
  ExplicitDynamics scheme(problem);
  Motion motion;
  motion.q.assign(index(model.dofs()), 0.0);
  motion.v = motion.q;
  for (std::size_t i = 0; i < motion.q.size(); i += 3) {  // most at the end, none at the begin
    const double part = model.mesh().points[i] / edge;
    motion.q[i] = -s.compression * edge * part * part;
  }
  if (scheme.begin(motion, 0.0)) std::abort();
  const double count = model.mesh().cell_count();
  const int steps = std::max(1, static_cast<int>(20'000 / count));
  HighestFrequency frequency(model);
  const std::optional<FrequencyWatch::Bound> first =
      frequency.bound(motion.q, motion.history, std::pow(2.0 / stable_step(model), 2),
                      FrequencyWatch::Effort::bounded);
  if (!first) std::abort();
  double sum = 0.0;
  const double bound = least(repeats, [&] {
    sum +=
        frequency
            .bound(motion.q, motion.history, 0.97 * first->square, FrequencyWatch::Effort::bounded)
            ->square;
  });
  const double limit = stable_step(model, motion.q, motion.history);
  const double dt = 1.0e-6 * 2.0 / std::sqrt(first->square);  // the state hardly changes
  const double step = least(repeats,
                            [&] {
                              for (int k = 0; k < steps; ++k)
                                if (scheme.step(motion, 0.0, dt)) std::abort();
                            }) /
                      steps;
  if (!(sum > 0.0)) std::abort();
  const double ratio = bound / step;
  fmt::print("{:<34} {:>8} {:>8.0f} {:>8.0f} {:>7.1f} {:>8} {:>6.2f}% {:>10.4f}\n", s.words, count,
             step * 1.0e9 / count, bound * 1.0e9 / count, ratio, frequency.least_interval(),
             100.0 * ratio / frequency.least_interval(), 2.0 / std::sqrt(first->square) / limit);
}

/// Adds up the time that bounds take.
class TimedWatch final : public FrequencyWatch {
 public:
  TimedWatch(FeModel& model, double& seconds, int& count)
      : watch_(model), seconds_(seconds), count_(count) {}
  std::optional<Bound> bound(std::span<const double> q, std::span<const double> history,
                             double from, Effort effort) override {
    const std::clock_t ticks = std::clock();
    const std::optional<Bound> found = watch_.bound(q, history, from, effort);
    seconds_ += static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC;
    ++count_;
    return found;
  }
  std::string place(const Bound& bound) const override { return watch_.place(bound); }
  int least_interval() const override { return watch_.least_interval(); }

 private:
  HighestFrequency watch_;
  double& seconds_;
  int& count_;
};

/// A whole run: a cube of rubber that flies into itself, to two thirds of its length.
void run_deforming(int edge, double distortion, int steps) {
  FeOptions options;
  options.batched = true;
  FeModel model(mesh_of(edge, distortion), std::make_unique<NeoHookean>(rubber, 1000.0), options);
  Problem problem;
  problem.model = &model;
  double bounds = 0.0;
  int count = 0;
  const double limit = stable_step(model), speed = 0.25 * std::sqrt(rubber.p_wave() / 1000.0);
  StableSteps scheme(std::make_unique<ExplicitDynamics>(problem),
                     std::make_unique<TimedWatch>(model, bounds, count),
                     {0.95 * limit, limit, true});
  Motion motion;
  motion.q.assign(index(model.dofs()), 0.0);
  motion.v = motion.q;
  for (std::size_t i = 0; i < motion.v.size(); i += 3)
    motion.v[i] = speed * (1.0 - 2.0 * model.mesh().points[i] / edge);
  if (scheme.begin(motion, 0.0)) std::abort();
  const double energy = scheme.kinetic(motion);
  double worst = 0.0;
  bounds = 0.0;
  count = 0;
  const std::clock_t ticks = std::clock();
  for (int k = 0; k < steps; ++k) {
    if (scheme.step(motion, k * 0.95 * limit, 0.95 * limit)) std::abort();
    worst = std::max(worst, std::abs(scheme.kinetic(motion) + motion.stored - energy));
  }
  const double all = static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC;
  const std::vector<double> told = scheme.measure(motion);
  fmt::print(
      "a cube of {} elements in {} steps, to {:.2f} of its limit: {} bounds, {:.2f}% of the "
      "run; at most {:.0f} parts; energy to {:.2g}\n",
      model.mesh().cell_count(), steps, told[0] / limit, count, 100.0 * bounds / all, told[1],
      worst / energy);
}

void run_all(int edge, int repeats) {
  fmt::print("{:<34} {:>8} {:>8} {:>8} {:>7} {:>8} {:>7} {:>10}\n", "", "elements", "step", "bound",
             "ratio", "interval", "share", "bound/true");
  using enum Formulation;
  const Setting settings[] = {{"full, equal cells", full, 0.0, 0.0, false},
                              {"full, distorted by 5 %", full, 0.05, 0.0, false},
                              {"full, distorted by 20 %", full, 0.2, 0.0, false},
                              {"full, distorted 5 %, compressed", full, 0.05, 0.3, false},
                              {"one point, equal cells", one_point, 0.0, 0.0, false},
                              {"one point, distorted by 5 %", one_point, 0.05, 0.0, false},
                              {"one point, distorted, compressed", one_point, 0.05, 0.3, false}};
  for (const Setting& s : settings) run(s, edge, repeats);
  const Setting slow[] = {{"mean dilatation, compressed", mean_dilatation, 0.05, 0.3, false},
                          {"full, J2, compressed", full, 0.05, 0.3, true}};
  for (const Setting& s : slow) run(s, std::min(edge, 12), repeats);
  for (const double distortion : {0.0, 0.05}) run_deforming(edge, distortion, 600);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int edge = argc > 1 ? std::max(2, std::atoi(argv[1])) : 32;
  abut::run_all(edge, argc > 2 ? std::max(1, std::atoi(argv[2])) : 5);
  return 0;
}
