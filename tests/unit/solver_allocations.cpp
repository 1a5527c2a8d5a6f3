// Goal: a window costs no allocation once buffers have grown: of bars, pairs, rigid and modal
// bodies and walls, and of solids under every scheme, law, dimension and formulation, free and held
// and loaded. Oracle: a count of malloc.
//
// Not claimed: conjugate gradients and CHOLMOD, which make their own vectors in every solve (cases
// with a sparse solver are left out where the build has CHOLMOD).

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "subdomain_solver/solve/cholmod_solver.hpp"
#include "tests/support/scenes.hpp"

namespace {
std::atomic<long> allocations{0};
void count() { allocations.fetch_add(1, std::memory_order_relaxed); }
}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
// malloc is the sanitizer's: what matrices take for themselves is not seen.
[[gnu::noinline]] void* operator new(std::size_t size) {
  count();
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  count();
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#else
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  count();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  count();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}
#endif

namespace abut::solver_allocations_tests {
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

const std::string elastic = "youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0";
const std::string linear = "linear_elastic: {" + elastic + "}";
const std::string rubber = "neo_hookean: {" + elastic + "}";

/// A law and what the model says beside its mesh.
std::string solid(const std::string& model, int dim, const std::string& law,
                  const std::string& integrator, const std::string& more,
                  const std::string& element = "") {
  const std::vector<std::string> meshes = {
      "bar: {{length: 3.0, elements: 3, area: 2.0}}",
      "rectangle: {{lengths: [3.0, 2.0], elements: [3, 2]{}}}",
      "box: {{lengths: [3.0, 2.0, 2.0], elements: [3, 2, 2]{}}}"};
  const std::vector<std::string> velocity = {"0.1", "0.1, 0.0", "0.1, 0.0, 0.0"};
  const std::string mesh = fmt::format(fmt::runtime(meshes[dim - 1]),
                                       element.empty() ? "" : ", element: " + element);
  const bool moves = integrator.find("quasi_static") == std::string::npos;
  return fmt::format(
      "model: {{{}dimension: {}, mesh: {{{}}}}}}}, material: {{{}}}, integrator: {{{}}}, {}"
      "ports: {{face: {{side: right}}}}{}",
      model, dim, mesh, law_in(dim, law), integrator,
      moves ? fmt::format("initial: {{velocity_field: [{}]}}, ", velocity[dim - 1]) : "",
      more);
}

/// Held at one side and loaded in every way; in one dimension by traction and weight alone.
std::string held(int dim) {
  if (dim == 1)
    return ", constraints: {clamp: {on: left, fixed: true}}, loads: {weight: {acceleration: "
           "['1e-3*sin(t)']}, pull: {on: right, traction: ['1e-3*t']}}";
  const std::string third = dim == 3 ? ", '0'" : "";
  return fmt::format(
      ", constraints: {{clamp: {{on: left, x: '1e-3*sin(t)', y: '0'{}}}, slope: {{on: corner, "
      "direction: [0.6, 0.8{}]}}}}, loads: {{weight: {{acceleration: ['1e-3*sin(t)', '0'{}]}}, "
      "pull: {{on: top, traction: ['1e-3*t', '0'{}]}}, press: {{on: right, pressure: '1e-3*t', "
      "follows: true}}}}, points: {{corner: {{at: [3.0, 0.0{}]}}}}",
      dim == 3 ? ", z: '0'" : "", dim == 3 ? ", 0.0" : "", third, third, dim == 3 ? ", 0.0" : "");
}

const std::vector<std::string>& schemes() {
  static const std::vector<std::string> list = {"central_difference", "newmark", "hht_alpha",
                                                "generalized_alpha", "quasi_static"};
  return list;
}

std::string stepping(const std::string& scheme) { return scheme + ": {step: 0.1}"; }

/// Every scheme with every law in every dimension, free and held; statics are held.
void add_solids(std::vector<Counted>& out) {
  const std::vector<std::string> laws = {
      linear,
      "saint_venant_kirchhoff: {" + elastic + "}",
      rubber,
      "mooney_rivlin: {c10: 0.1, c01: 0.1, bulk_modulus: 1.0, density: 1.0}",
      "hencky: {" + elastic + "}",
      "j2_plasticity: {" + elastic + ", yield_stress: 1.0e-3, hardening: 0.1}"};
  for (const std::string& scheme : schemes()) {
    for (const std::string& law : laws) {
      for (const int dim : {1, 2, 3}) {
        for (const bool is_held : {false, true}) {
          if (!is_held && scheme == "quasi_static") continue;
          if (dim == 1 && !is_held && law == linear) continue;  // a bar, counted above
          out.push_back({fmt::format("{}_{}_{}d{}", scheme, law.substr(0, law.find(':')), dim,
                                     is_held ? "_held" : ""),
                         solid("fe: {", dim, law, stepping(scheme), is_held ? held(dim) : "")});
        }
      }
    }
  }
}

/// Every scheme with every formulation and plane, linear and not, of linear and quadratic cells.
void add_formulations(std::vector<Counted>& out) {
  const std::vector<std::string> forms = {
      "formulation: mean_dilatation, ", "formulation: one_point, ", "plane: stress, ",
      "plane: axisymmetric, "};
  for (const std::string& scheme : schemes()) {
    for (const std::string& law : {linear, rubber}) {
      for (const std::string& form : forms) {
        const bool plane = form.starts_with("plane");
        for (const std::string element : {"quad4", "quad8", "hex8", "hex20"}) {
          const bool linear_cell = element == "quad4" || element == "hex8";
          if (!linear_cell && form.find("one_point") != std::string::npos) continue;
          const int dim = element.starts_with("hex") ? 3 : 2;
          if (dim == 3 && plane) continue;
          std::string key = form.substr(form.find(' ') + 1);
          key.resize(key.find(','));
          out.push_back({fmt::format("{}_{}_{}_{}", scheme, law.substr(0, law.find(':')), key,
                                     element),
                         solid("fe: {" + form, dim, law, stepping(scheme), held(dim), element)});
        }
      }
    }
  }
}

std::vector<Counted> counted() {
  const std::string explicit_step = "central_difference: {step: 0.1}";
  const std::string loads =
      ", loads: {pull: {on: left, traction: ['0.01 * t']}, wind: {acceleration: ['0.001 * x']}}";
  const std::string pair =
      "model: {{bar_pair: {{contact: {{lagrange_multiplier: {{}}}}, left: {{length: 20.0, "
      "elements: 20, area: "
      "1.0, position: -20.0, velocity: 0.1}}, right: {{length: 20.0, elements: 20, area: 1.0, "
      "position: 0.0}}}}}}, material: {{linear_elastic: {{youngs_modulus: 1.0, density: 1.0}}}}, "
      "integrator: {{{}}}";
  std::vector<Counted> out = {
      {"bar_explicit", bar(explicit_scheme(0.6), "")},
      {"bar_explicit_terms", bar(explicit_scheme(0.6, 6), ", contact_layer: {kick: {}}")},
      {"bar_implicit", bar("newmark: {step: 0.6}", "")},
      {"bar_loaded", bar(explicit_scheme(0.6, 6), loads)},
      {"bar_loaded_implicit", bar("newmark: {step: 0.6}", loads)},
      {"pair_explicit", fmt::format(fmt::runtime(pair), "central_difference: {step: 0.6}")},
      {"pair_implicit", fmt::format(fmt::runtime(pair), "newmark: {step: 0.6}")},
      {"rigid", solid("rigid: {", 3, linear, "rigid_motion: {step: 0.1}", "")},
      {"rigid_plane", solid("rigid: {", 2, linear, "rigid_motion: {step: 0.1}", "")},
      {"threads", solid("fe: {threads: 2, ", 3, rubber, explicit_step, "")},
      {"wall", "model: {rigid_wall: {}}, initial: {position: [0.0]}, ports: {wall: {side: left}}"},
  };
  const std::string clamped =
      ", constraints: {clamp: {on: left, fixed: true}}, loads: {pull: {on: top, traction: "
      "['1e-3*t', '0', '0']}}";
  for (const std::string& scheme : schemes()) {
    if (scheme == "quasi_static") continue;
    const std::string steps = stepping(scheme), modes = "modal: {modes: 4, ";
    out.push_back({scheme + "_modal", solid(modes, 3, linear, steps, "")});
    out.push_back({scheme + "_modal_held", solid(modes, 3, linear, steps, clamped)});
  }
  add_solids(out);
  add_formulations(out);
  return out;
}

class Allocations : public testing::TestWithParam<Counted> {};
INSTANTIATE_TEST_SUITE_P(Solver, Allocations, testing::ValuesIn(counted()),
                         [](const auto& c) { return c.param.name; });

/// Forces on all points of a port, other ones in every window, and not at the same instants.
void push(const Port& port, const TimeWindow& window, Waveform& force) {
  const std::size_t width = port.geometry.points.size();
  const int parts = window.index % 2 == 0 ? 10 : 7;
  force.clear();
  force.width = static_cast<int>(width);
  for (int i = 0; i <= parts; ++i) {
    force.time.push_back(window.begin + i * window.length() / parts);
    for (std::size_t k = 0; k < width; ++k) force.f.push_back(1.0e-4 * (i + window.begin));
  }
  force.time.back() = window.end;
}

/// Bars have solvers of their own, and explicit steps need none.
bool needs_sparse_solver(const std::string& name) {
  return std::any_of(schemes().begin(), schemes().end(), [&name](const std::string& scheme) {
    return scheme != "central_difference" && name.starts_with(scheme);
  });
}

void advance_or_fail(Subdomain& body, const Advance& request, Response& response) {
  const Outcome outcome = body.advance(request, response);
  if (const Failed* failed = std::get_if<Failed>(&outcome)) FAIL() << failed->detail;
}

TEST_P(Allocations, AreNoneFromTheSecondWindowOn) {
  if (needs_sparse_solver(GetParam().name) && make_cholmod_solver(Pivots::every) != nullptr)
    GTEST_SKIP() << "CHOLMOD makes its vectors in every solve";
  for (const bool obstructed : {false, true}) {
    const std::unique_ptr<Subdomain> body = make_body(
        Document::from_text("test", "bodies: {it: {" + GetParam().body + "}}"), "bodies.it");
    const Description& d = body->describe();
    if (obstructed && !d.can.obstacle) continue;
    if (obstructed) body->meet({0, 0, &d.ports[0].geometry});
    const double length = d.step > 0.0 ? 10.0 * d.step : 6.0;
    Advance request = free_request(*body, 0.0, 0.0, 2);
    Response response;
    for (int w = 0; w < 5; ++w) {
      request.window = {w, length * w, length * (w + 1)};
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
      advance_or_fail(*body, request, response);
      body->restore();
      advance_or_fail(*body, request, response);
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
}  // namespace abut::solver_allocations_tests
