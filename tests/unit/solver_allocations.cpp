// Goal: a window costs no allocation once buffers have grown. Oracle: a count of operator new.

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/scenes.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace abut {
namespace {

struct Counted {
  std::string name, body;  // what a scene says of it
  friend std::ostream& operator<<(std::ostream& out, const Counted& c) { return out << c.name; }
};

std::string bar(const std::string& integrator, const std::string& more) {
  return fmt::format(
      "model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 40.0, elements: 40, area: 1.0}}}}}}}}, "
      "material: {{linear_elastic: {{youngs_modulus: 1.0, density: 1.0}}}}, "
      "integrator: {{{}}}, initial: {{velocity: [0.1]}}, ports: {{tip: {{side: right}}}}{}",
      integrator, more);
}

std::string solid(const std::string& model, const std::string& law, const std::string& integrator) {
  return fmt::format(
      "model: {{{}dimension: 3, mesh: {{box: {{lengths: [3.0, 2.0, 2.0], elements: [3, 2, "
      "2]}}}}}}}}"
      ", material: {{{}}}, integrator: {{{}}}, initial: {{velocity: [0.1, 0.0, 0.0]}}, "
      "ports: {{face: {{side: right}}}}",
      model, law, integrator);
}

std::vector<Counted> counted() {
  const std::string elastic = "{youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}";
  const std::string linear = "linear_elastic: " + elastic, rubber = "neo_hookean: " + elastic;
  const std::string explicit_step = "central_difference: {step: 0.1}";
  const std::string loads =
      ", loads: {pull: {on: left, traction: ['0.01 * t']}, wind: {acceleration: ['0.001 * x']}}";
  const std::string pair =
      "model: {{bar_pair: {{contact: {{lagrange_multiplier: {{}}}}, left: {{length: 20.0, "
      "elements: 20, area: "
      "1.0, position: -20.0, velocity: 0.1}}, right: {{length: 20.0, elements: 20, area: 1.0, "
      "position: 0.0}}}}}}, material: {{linear_elastic: {{youngs_modulus: 1.0, density: 1.0}}}}, "
      "integrator: {{{}}}";
  return {
      {"bar_explicit", bar(explicit_scheme(0.6), "")},
      {"bar_explicit_terms", bar(explicit_scheme(0.6, 6), ", contact_layer: {kick: {}}")},
      {"bar_implicit", bar("newmark: {step: 0.6}", "")},
      {"bar_loaded", bar(explicit_scheme(0.6, 6), loads)},
      {"bar_loaded_implicit", bar("newmark: {step: 0.6}", loads)},
      {"pair_explicit", fmt::format(fmt::runtime(pair), "central_difference: {step: 0.6}")},
      {"pair_implicit", fmt::format(fmt::runtime(pair), "newmark: {step: 0.6}")},
      {"rigid", solid("rigid: {", linear, "rigid_motion: {step: 0.1}")},
      {"modal", solid("modal: {modes: 4, ", linear, explicit_step)},
      {"solid_linear", solid("fe: {", linear, explicit_step)},
      {"solid_rubber", solid("fe: {", rubber, explicit_step)},
      {"wall", "model: {rigid_wall: {}}, initial: {position: [0.0]}, ports: {wall: {side: left}}"},
  };
}

class Allocations : public testing::TestWithParam<Counted> {};
INSTANTIATE_TEST_SUITE_P(Solver, Allocations, testing::ValuesIn(counted()),
                         [](const auto& c) { return c.param.name; });

/// Forces on all points of a port, other ones in every window.
void push(const Port& port, const TimeWindow& window, Waveform& force) {
  const std::size_t width = port.geometry.points.size();
  force.clear();
  force.width = static_cast<int>(width);
  for (int i = 0; i <= 10; ++i) {
    force.time.push_back(window.begin + 0.1 * i * window.length());
    for (std::size_t k = 0; k < width; ++k) force.f.push_back(0.01 * (i + window.begin));
  }
  force.time.back() = window.end;
}

TEST_P(Allocations, AreNoneFromTheSecondWindowOn) {
  for (const bool obstructed : {false, true}) {
    const std::unique_ptr<Subdomain> body = make_body(
        Document::from_text("test", "bodies: {it: {" + GetParam().body + "}}"), "bodies.it");
    const Description& d = body->describe();
    if (obstructed && !d.can.obstacle) continue;
    if (obstructed) body->meet(0, d.ports[0].geometry, {});
    Advance request = free_request(*body, 0.0, 0.0, 2);
    Response response;
    for (int w = 0; w < 5; ++w) {
      request.window = {w, 6.0 * w, 6.0 * (w + 1)};
      BoundaryData& data = request.boundary[0];
      data.clear();
      if (obstructed) {
        data.obstacles.resize(1);
        Waveform& motion = data.obstacles[0].motion;
        motion.time = {request.window.begin, request.window.end};
        motion.u = {0.0, 0.0};
      } else if (d.can.force) {
        data.forces.resize(1);
        push(d.ports[0], request.window, data.forces[0]);
      }
      if (w == 0) body->save();
      const long before = allocations.load();
      ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
      body->restore();
      ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
      const long both = allocations.load() - before;
      body->save();  // grows once more after the first window: the start keeps no accelerations
      if (w > 0) {
        EXPECT_EQ(both, 0) << "window " << w;
      }
      if (w > 1) {
        EXPECT_EQ(allocations.load() - before, 0) << "saved after window " << w;
      }
    }
  }
}

}  // namespace
}  // namespace abut
