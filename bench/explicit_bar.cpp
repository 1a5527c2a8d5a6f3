/// Cost of the explicit bar: whole substeps of a Body behind the contract, in 100-step windows, per
/// element and step; beside it what the machine's memory allows for the same traffic, measured in
/// the same run.
///
///   abut_bench_explicit_bar [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "base/index.hpp"
#include "base/yaml_document.hpp"
#include "subdomain_solver/make/body_spec.hpp"

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

std::unique_ptr<Subdomain> make_bar(int elements, int terms) {
  // Elements of 1.25e-3 m as in the shipped scenes; CFL 0.8.
  const std::string text = fmt::format(R"(
bodies:
  bar:
    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: {}, elements: {}, area: 1.0e-6}}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e9, density: 1000.0}}}}
    integrator: {{central_difference: {{step: 1.0e-6, dispersion_terms: {}}}}}
    initial: {{velocity: [100.0]}}
    ports: {{tip: {{side: right}}}}
)",
                                       1.25e-3 * elements, elements, terms);
  return make_body(Document::from_text("bench", text, {}), "bodies.bar");
}

/// Nanoseconds per element and step, median of the repeats. `closed`: the port meets a wall.
double cost(int elements, int terms, bool closed, int repeats) {
  const int steps = 100;
  const int windows = std::max(1, 20'000'000 / (elements * steps));
  std::unique_ptr<Subdomain> bar = make_bar(elements, terms);
  Response response;
  Advance request;
  request.sampling = closed ? Sampling::substeps : Sampling::records;
  request.boundary.resize(1);
  if (closed) {
    bar->meet({0, 0, &bar->describe().ports[0].geometry, {.tied = true}});
    request.boundary[0].obstacles.resize(1);
  }
  std::vector<double> samples;
  double time = 0.0;
  for (int r = 0; r <= repeats; ++r) {
    const double wall = seconds([&] {
      for (int w = 0; w < windows; ++w) {
        request.window = {w, time, time + 1.0e-4};
        if (closed) {
          Waveform& motion = request.boundary[0].obstacles[0].motion;
          motion.clear();
          for (int i = 0; i <= steps; ++i) {
            motion.time.push_back(i == steps ? request.window.end : time + i * 1.0e-6);
            motion.u.push_back(0.0);
          }
        }
        if (!std::holds_alternative<Advanced>(bar->advance(request, response))) std::abort();
        time += 1.0e-4;
      }
    });
    if (r > 0) samples.push_back(wall * 1.0e9 / (double(windows) * steps * elements));
  }
  return median(samples);
}

/// Nanoseconds per element for reading and writing two arrays of doubles, which is what a step must
/// move at least.
double streaming_limit(std::size_t elements, int repeats) {
  std::vector<double> u(elements, 1.0), v(elements, 2.0);
  std::vector<double> samples;
  for (int r = 0; r <= repeats; ++r) {
    const double factor = 1.0 + 1.0e-9 * r;
    const double wall = seconds([&] {
      double* __restrict pu = u.data();
      double* __restrict pv = v.data();
      for (std::size_t i = 0; i < elements; ++i) {
        pv[i] *= factor;
        pu[i] += pv[i];
      }
    });
    if (r > 0) samples.push_back(wall * 1.0e9 / static_cast<double>(elements));
  }
  return median(samples);
}

void run(int repeats) {
  fmt::print("explicit bar, whole steps in 100-step windows, median of {}\n", repeats);
  fmt::print("{:>10} {:>7} {:>9} {:>20}\n", "elements", "terms", "port", "ns per element-step");
  for (const int elements : {200, 500, 1000, 10'000}) {
    for (const bool closed : {false, true}) {
      fmt::print("{:>10} {:>7} {:>9} {:>20.3f}\n", elements, 1, closed ? "closed" : "free",
                 cost(elements, 1, closed, repeats));
    }
  }
  for (const int elements : {200, 1000}) {
    fmt::print("{:>10} {:>7} {:>9} {:>20.3f}\n", elements, 6, "free",
               cost(elements, 6, false, repeats));
  }
  const int beyond = 8'000'000;  // 128 MB of state: beyond the caches
  const double large = cost(beyond, 1, false, 3);
  const double limit = streaming_limit(index(beyond), 9);
  fmt::print("{:>10} {:>7} {:>9} {:>20.3f}   streaming limit {:.3f}, ratio {:.2f}\n", beyond, 1,
             "free", large, limit, large / limit);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  abut::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 15);
  return 0;
}
