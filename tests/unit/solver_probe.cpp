// Goal: probes tell how ports of many points answer forces, in one, two and three dimensions, and
// leave no trace; surfaces take forces and show themselves on the points that are listed.
// Oracles: Betti's reciprocity, superposition, the motion under the same forces from rest, equal
// hashes.

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "contract/kernel_parts.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_probe_tests {
namespace {

struct Probed {
  std::string name, model, integrator;
  int dim = 2;

  /// `more` moves the body by itself.
  std::unique_ptr<Subdomain> build(bool more) const {
    const char* meshes[] = {"bar: {length: 1.0, elements: 4, area: 1.0, grading: 1.1}",
                            "rectangle: {lengths: [1.0, 1.0], elements: [2, 3]}",
                            "box: {lengths: [1.0, 1.0, 1.0], elements: [2, 1, 2]}"};
    const char* motions[] = {"[\"0.3\"]", "[\"0.1 * x\", \"0.2\"]",
                             "[\"0\", \"0.1 * z\", \"0.2\"]"};
    const char* forces[] = {"[1.0]", "[1.0, 2.0]", "[1.0, 2.0, 3.0]"};
    const std::size_t d = index(dim) - 1;
    std::string text = fmt::format(
        "bodies:\n  part:\n    model: {{{}dimension: {}, mesh: {{{}}}}}}}\n    material: {{{}}}\n"
        "    integrator: {{{}}}\n    constraints: {{clamp: {{on: left, fixed: true}}}}\n"
        "    ports: {{lid: {{side: right}}}}\n",
        model, dim, meshes[d],
        law_in(dim, "linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}"),
        integrator);
    if (more)
      text += fmt::format("    initial: {{velocity_field: {}}}\n    body_force: {}\n", motions[d],
                          forces[d]);
    return make_body(Document::from_text("test", text), "bodies.part");
  }
  friend std::ostream& operator<<(std::ostream& out, const Probed& p) { return out << p.name; }
};

constexpr double substep = 0.05;
constexpr int count = 12;

std::vector<Probed> probed() {
  std::vector<Probed> all;
  for (int dim : {1, 2, 3}) {
    const std::string d = std::to_string(dim);
    for (const char* scheme : {"central_difference", "newmark", "generalized_alpha"})
      all.push_back({"fe" + d + "_" + scheme, "fe: {", implicit_scheme(scheme, substep), dim});
    all.push_back({"modal" + d, "modal: {modes: 3, ", implicit_scheme("newmark", substep), dim});
  }
  return all;
}

class Probe : public testing::TestWithParam<Probed> {};
INSTANTIATE_TEST_SUITE_P(Solver, Probe, testing::ValuesIn(probed()),
                         [](const auto& p) { return p.param.name; });

std::vector<double> unit_patterns(std::size_t width) {
  std::vector<double> patterns(width * width, 0.0);
  for (std::size_t i = 0; i < width; ++i) patterns[i * width + i] = 1.0;
  return patterns;
}

TEST_P(Probe, IsReciprocal) {
  const std::unique_ptr<Subdomain> body = GetParam().build(true);
  ASSERT_TRUE(body->describe().can.kernel);
  const std::size_t width = body->describe().ports[0].geometry.points.size();
  const PortKernel kernel = body->probe({0, unit_patterns(width), substep, count});
  ASSERT_EQ(kernel.count(), count);
  ASSERT_EQ(kernel.patterns * kernel.width, static_cast<int>(width * width));
  for (const std::vector<double>* responses : {&kernel.displacement, &kernel.begin}) {
    ASSERT_EQ(responses->size(), index(count) * width * width);
    for (std::size_t i = 0; i < responses->size(); ++i) {
      const std::size_t s = i / (width * width), under = i / width % width, at = i % width;
      EXPECT_NEAR((*responses)[i], (*responses)[(s * width + at) * width + under],
                  roundoff(10000, largest_size(*responses)));
    }
    EXPECT_GT(largest_size(*responses), 0.0);
  }
}

TEST_P(Probe, Superposes) {
  const std::unique_ptr<Subdomain> body = GetParam().build(false);
  const std::size_t width = body->describe().ports[0].geometry.points.size();
  const PortKernel units = body->probe({0, unit_patterns(width), substep, count});
  std::vector<double> pattern;
  for (std::size_t i = 0; i < width; ++i) pattern.push_back(1.0 + 0.5 * static_cast<double>(i));
  const PortKernel whole = body->probe({0, pattern, substep, count});
  EXPECT_EQ(whole.patterns, 1);
  for (std::size_t i = 0; i < whole.displacement.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < width; ++k)
      sum += pattern[k] * units.displacement[(i / width * width + k) * width + i % width];
    EXPECT_NEAR(whole.displacement[i], sum, roundoff(10000, largest_size(whole.displacement)));
  }
}

// Kernels that no message holds are asked for in parts: each pattern is pressed for itself.
TEST_P(Probe, InPartsIsTheWholeToTheLastBit) {
  const std::unique_ptr<Subdomain> body = GetParam().build(true);
  const std::size_t width = body->describe().ports[0].geometry.points.size();
  const std::vector<double> units = unit_patterns(width);
  const PortKernel whole = body->probe({0, units, substep, count});
  for (const std::size_t at_once : {std::size_t{1}, (width + 1) / 2}) {
    PortKernel made = room_for(whole, whole.patterns);
    for (std::size_t first = 0; first < width; first += at_once) {
      const std::size_t some = std::min(at_once, width - first);
      const auto from = units.begin() + static_cast<std::ptrdiff_t>(first * width);
      const std::vector<double> part(from, from + static_cast<std::ptrdiff_t>(some * width));
      put(body->probe({0, part, substep, count}), static_cast<int>(first), made);
    }
    EXPECT_EQ(made.displacement, whole.displacement);
    EXPECT_EQ(made.begin, whole.begin);
    EXPECT_EQ(made.compliance, whole.compliance);
  }
}

TEST_P(Probe, LeavesNoTraceAndSeesNoOtherLoad) {
  const std::unique_ptr<Subdomain> moving = GetParam().build(true),
                                   resting = GetParam().build(false);
  Response response;
  ASSERT_TRUE(
      std::holds_alternative<Advanced>(moving->advance(free_request(*moving, 0.0, 0.3), response)));
  const std::uint64_t hash = moving->state_hash();
  const std::size_t width = moving->describe().ports[0].geometry.points.size();
  const PortKernel one = moving->probe({0, unit_patterns(width), substep, count});
  EXPECT_EQ(moving->state_hash(), hash);
  const PortKernel two = resting->probe({0, unit_patterns(width), substep, count});
  EXPECT_EQ(one.displacement, two.displacement);
  EXPECT_EQ(one.begin, two.begin);
}

TEST_P(Probe, IsTheMotionUnderForcesFromRest) {
  const std::unique_ptr<Subdomain> body = GetParam().build(false);
  const PortGeometry& port = body->describe().ports[0].geometry;
  const std::size_t dim = index(port.dim), width = port.points.size();
  const PortKernel kernel = body->probe({0, unit_patterns(width), substep, count});
  // On the last point alone, which the reply shows alone.
  const std::int32_t last = port.count() - 1;
  Advance request = free_request(*body, 0.0, count * substep);
  Waveform& force = request.boundary[0].forces.emplace_back();
  force.width = port.dim;
  force.points = {last};
  for (int i = 0; i <= count; ++i) {
    force.time.push_back(i == count ? request.window.end : i * substep);
    for (std::size_t d = 0; d < dim; ++d)
      force.f.push_back(0.1 * i * static_cast<double>(d + 1) - 0.3);
  }
  request.want.resize(1);
  request.want[0].points = {last};
  request.want[0].v = false;
  Response response;
  const Outcome outcome = body->advance(request, response);
  ASSERT_TRUE(std::holds_alternative<Advanced>(outcome));
  const Waveform& seen = response.ports[0].trace;
  ASSERT_EQ(seen.width, port.dim);
  EXPECT_EQ(seen.points, force.points);
  EXPECT_EQ(seen.f, force.f);
  EXPECT_TRUE(seen.v.empty());
  const std::size_t first = index(last) * dim;
  for (std::size_t i = 1; i <= index(count); ++i) {
    for (std::size_t d = 0; d < dim; ++d) {
      double u = 0.0;
      for (std::size_t k = 0; k < dim; ++k) {
        const auto response_to = [&](const std::vector<double>& responses, std::size_t lag) {
          return responses[(lag * width + first + k) * width + first + d];
        };
        u += force.f[k] * response_to(kernel.begin, i - 1);
        for (std::size_t j = 1; j <= i; ++j)
          u += force.f[j * dim + k] * response_to(kernel.displacement, i - j);
      }
      EXPECT_NEAR(seen.u[i * dim + d], u, roundoff(10000, largest_size(seen.u)));
    }
  }
  for (std::size_t d = 0; d < dim; ++d) {  // boxes are of positions
    EXPECT_GE(response.ports[0].upper[d], port.points[first + d] + seen.u[count * dim + d]);
    EXPECT_LE(response.ports[0].lower[d], port.points[first + d]);
  }
}

}  // namespace
}  // namespace abut::solver_probe_tests
