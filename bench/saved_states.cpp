/// What keeping and taking back the state of an explicit solid costs beside a step of it: boxes of
/// hex8, one thread, by law.
///
///   abut_bench_saved_states [EDGE] [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {
namespace {

constexpr double step = 2.0e-7, goal = 0.1;

std::unique_ptr<Subdomain> box(int edge, const std::string& law) {
  const std::string text = fmt::format(
      R"(bodies:
  b:
    model:
      fe: {{dimension: 3, mesh: {{box: {{lengths: [1, 1, 1], elements: [{0}, {0}, {0}]}}}}}}
    material: {{{1}}}
    integrator: {{central_difference: {{step: {2}}}}}
    initial: {{velocity_field: ["10*x", "0", "0"]}}
    ports: {{face: {{side: left}}}}
)",
      edge, law, step);
  return make_body(Document::from_text("bench", text), "bodies.b");
}

/// [s] of processor time, the least of some repeats: other work on the machine only adds.
double least(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const std::clock_t began = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
  }
  return best;
}

void advance(Subdomain& body, int window, Response& reply) {
  Advance request;
  request.window = {window, step * window, step * (window + 1)};
  request.boundary.resize(body.describe().ports.size());
  request.want.resize(request.boundary.size());
  body.start(request);
  if (!std::holds_alternative<Advanced>(body.finish(reply))) std::abort();
}

void run(int edge, int repeats, const char* name, const std::string& law) {
  const std::unique_ptr<Subdomain> body = box(edge, law);
  Response reply;
  int window = 0;
  body->save();
  for (; window < 3; ++window) {
    advance(*body, window, reply);
    body->save();
  }
  // An accepted window; and one that is taken back each time.
  const double forward = least(repeats, [&] {
    advance(*body, window++, reply);
    body->save();
  });
  const double again = least(repeats, [&] {
    advance(*body, window, reply);
    body->restore();
  });
  const double saving = least(repeats, [&] { body->save(); });
  const double alone = forward - saving, restoring = std::max(0.0, again - alone);
  const double cells = double(edge) * edge * edge;
  fmt::print(
      "{:>22}: step {:6.1f} ns an element, save {:5.1f}, restore {:5.1f}: {:.3f} of the "
      "step (goal {})\n",
      name, 1.0e9 * alone / cells, 1.0e9 * saving / cells, 1.0e9 * restoring / cells,
      (saving + restoring) / alone, goal);
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const int edge = argc > 1 ? std::atoi(argv[1]) : 40, repeats = argc > 2 ? std::atoi(argv[2]) : 30;
  using abut::run;
  const std::string elastic = "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0";
  run(edge, repeats, "linear_elastic", fmt::format("linear_elastic: {{{}}}", elastic));
  run(edge, repeats, "neo_hookean", fmt::format("neo_hookean: {{{}}}", elastic));
  run(edge, repeats, "j2_plasticity",
      fmt::format("j2_plasticity: {{{}, yield_stress: 1.0e6}}", elastic));
}
