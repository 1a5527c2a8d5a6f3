/// What the machinery around the arithmetic costs when nothing optional is used: two_bars.yaml in
/// one process without observers, against a hand-written loop that takes the same steps of both
/// bars at once, and the allocations of a window in contact.
///
///   abut_bench_cost_of_absence [SCENE]

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/launch_local.hpp"
#include "subdomain_solver/bars/bar_kernels.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace abut {
namespace {

constexpr double accepted_ratio = 1.5;
constexpr int repeats = 21;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// Counts what is allocated between two accepted windows in contact.
class AllocationCounter final : public Observer {
 public:
  void on_window(const WindowReport& report) override {
    const long now = allocations.load();
    const bool closed = report.interfaces[0].closed;
    if (closed && was_closed_) counts.push_back(static_cast<double>(now - before_));
    was_closed_ = closed;
    before_ = allocations.load();
  }
  std::vector<double> counts;

 private:
  bool was_closed_ = false;
  long before_ = 0;
};

double run_scene(const Scene& scene, const Document& document, std::vector<Observer*> observers) {
  std::vector<std::unique_ptr<Subdomain>> bodies = launch_local(scene, document);
  std::vector<Subdomain*> pointers;
  for (const std::unique_ptr<Subdomain>& body : bodies) pointers.push_back(body.get());
  const auto began = std::chrono::steady_clock::now();
  Controller controller(scene, pointers, std::move(observers));
  if (controller.run().status != "completed") std::abort();
  return seconds_since(began);
}

/// One bar of two_bars.yaml: 200 elements, massless layer with factor 1.4, six dispersion terms.
/// Node 0 is the tip.
struct HandBar {
  static constexpr std::size_t nodes = 201;
  double u[nodes] = {}, v[nodes] = {}, s[nodes] = {}, t[nodes] = {};
  double direction, ratio[5];

  explicit HandBar(double towards) : direction(towards) {
    std::fill(v, v + nodes, 100.0 * towards);
    for (int q = 2; q <= 6; ++q) {
      ratio[q - 2] = ((q - 1.0) * (q - 1.0) - 0.0064) / (2.0 * q * (2.0 * q - 1.0));
    }
  }
  void smooth(bool closed) {
    const double* in = u;
    for (int pass = 4; pass >= 0; --pass) {
      double* out = in == s ? t : s;
      smooth_nodes(u, in, out, 2, nodes - 2, ratio[pass]);
      const double last = 2.0 * (in[nodes - 1] - in[nodes - 2]);
      out[nodes - 1] = u[nodes - 1] + ratio[pass] * last;
      out[nodes - 2] = u[nodes - 2] + ratio[pass] * ((in[nodes - 2] - in[nodes - 3]) -
                                                     (in[nodes - 1] - in[nodes - 2]));
      const double second = (1.4 * (in[1] - in[0]) - (in[2] - in[1])) / 1.5;
      out[1] = u[1] + ratio[pass] * second;
      out[0] = closed ? u[0] : out[1];
      in = out;
    }
    if (in != s) std::copy(t, t + nodes, s);
  }
  void step(double dt, bool closed, double place) {
    const double g = dt * 6.4e11;  // k / m of an element
    v[1] += g * ((s[2] - s[1]) - 1.4 * (s[1] - s[0])) / 1.5;
    v[nodes - 2] += g * ((s[nodes - 1] - s[nodes - 2]) - (s[nodes - 2] - s[nodes - 3]));
    v[nodes - 1] -= 2.0 * g * (s[nodes - 1] - s[nodes - 2]);
    kick_nodes(s, v, 2, nodes - 2, g, 0.0);
    drift_nodes(u, v, 1, nodes, dt);
    u[0] = closed ? place : u[1];
    smooth(closed);
  }
  double force() const { return 1.4 * 8.0e5 * direction * (s[1] - s[0]); }
};

/// The whole run: both bars step by step, by symmetry against the middle. Returns a value so that
/// nothing is left out.
double run_by_hand() {
  HandBar left(1.0), right(-1.0);
  const double dt = 1.0e-7;
  bool closed = false;
  for (int n = 0; n < 10'000; ++n) {
    left.step(dt, closed, 0.02);
    right.step(dt, closed, -0.02);
    if (!closed) {
      closed = n < 5000 && left.u[0] >= 0.02;
    } else if (left.force() < 0.0) {
      closed = false;
    }
  }
  return left.v[100] - right.v[100];
}

int run(const char* path) {
  // The scene as shipped, but for what only its files want.
  const Document document = Document::load(path, {"output.records_per_window=1"});
  const Scene scene = read_scene(document);
  std::vector<double> product, hand;
  double check = 0.0;
  for (int r = 0; r <= repeats; ++r) {
    const double with = run_scene(scene, document, {});
    const auto began = std::chrono::steady_clock::now();
    check = run_by_hand();
    const double without = seconds_since(began);
    if (r == 0) continue;
    product.push_back(with);
    hand.push_back(without);
  }
  AllocationCounter counter;
  run_scene(scene, document, {&counter});
  const double ratio = median(product) / median(hand);
  const double allocated = median(counter.counts);
  fmt::print("two_bars.yaml in one process {:.2f} ms, by hand {:.2f} ms (bars end at {:.2f} m/s)\n",
             median(product) * 1e3, median(hand) * 1e3, 0.5 * check);
  fmt::print(
      "ratio {:.2f}, limit {:.1f}; allocations per window in contact {:.0f}, limit 0; medians of "
      "{}\n",
      ratio, accepted_ratio, allocated, repeats);
  return ratio <= accepted_ratio && allocated == 0.0 ? 0 : 1;
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) { return abut::run(argc > 1 ? argv[1] : "configs/two_bars.yaml"); }
