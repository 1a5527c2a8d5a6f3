// Goal: contact in axisymmetry, where rows weigh by the radius, and surfaces that lose their mass
// along the normal alone. Oracles: without lateral strain a cylinder is a bar, and equal bars
// exchange their velocities; balance of momentum along the axis; energy.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/runs.hpp"

namespace abut::surfaces_of_rings_tests {
namespace {

struct Rings {
  std::string name, model, material, integrator, layer;
  int dim = 2;
  bool elastic = true;
};

void PrintTo(const Rings& rings, std::ostream* out) { *out << rings.name; }

constexpr double speed = 0.01;  // of that of sound

/// A cylinder, or a block, along y (z in space).
SolidText column(const Rings& rings, const std::string& name, int across, double place, double v) {
  const bool upper = v < 0.0, round = rings.model.find("axisymmetric") != std::string::npos;
  std::vector<double> lengths = {0.25, 1.0}, at = {0.0, place}, moving = {0.0, v};
  std::vector<int> cells = {across, 8};
  if (rings.dim == 3) {
    lengths = {0.25, 0.25, 1.0}, at = {0.0, 0.0, place}, moving = {0.0, 0.0, v};
    cells = {across, across, 8};
  }
  const std::string low = rings.dim == 3 ? "back" : "bottom",
                    high = rings.dim == 3 ? "front" : "top";
  return {
      .name = name,
      .dim = rings.dim,
      .mesh = block_mesh(lengths, cells),
      .material = rings.material,
      .integrator = rings.integrator,
      .position = at,
      .velocity = moving,
      .side = upper ? low : high,
      .keys = rings.model,
      .more = rings.layer + (round ? "    constraints: {axis: {on: left, symmetry: true}}\n" : "")};
}

std::vector<Rings> all() {
  const std::string j2 = unit_law("j2_plasticity", 0.0, ", yield_stress: 0.005, hardening: 0.1");
  std::vector<Rings> out;
  for (const std::string formulation : {"full", "one_point", "mean_dilatation"})
    for (const std::string& law :
         {unit_law("linear_elastic", 0.0), unit_law("neo_hookean", 0.0), j2})
      for (const std::string scheme : {"central_difference", "newmark", "generalized_alpha"})
        for (const std::string directions : {"all", "normal"})
          for (const std::string plane : {"axisymmetric", "strain", "space"}) {
            if (formulation == "one_point" && scheme != "central_difference") continue;
            const bool flat = plane != "axisymmetric";
            if (flat && directions == "all") continue;  // surface_combinations has them
            const std::string name = law.substr(0, law.find(':'));
            // what differs is the layer's affair and the law's each, not that of alpha schemes too
            if (name == "j2_plasticity" && directions == "normal" && scheme == "generalized_alpha")
              continue;
            // in space one law and scheme each: what differs is not the law's affair
            if (plane == "space" && (name != "linear_elastic" || formulation != "full")) continue;
            out.push_back(
                {fmt::format("{}_{}_{}_{}_{}", plane, formulation, name, scheme, directions),
                 fmt::format("{}formulation: {}, ",
                             plane == "space" ? "" : "plane: " + plane + ", ", formulation),
                 law, scheme + ": {step: 0.0125}",
                 fmt::format("    contact_layer: {{massless: {{directions: {}}}}}\n", directions),
                 plane == "space" ? 3 : 2, name != "j2_plasticity"});
          }
  return out;
}

class SurfaceRings : public testing::TestWithParam<Rings> {};
INSTANTIATE_TEST_SUITE_P(Combinations, SurfaceRings, testing::ValuesIn(all()),
                         [](const auto& c) { return c.param.name; });

TEST_P(SurfaceRings, TouchAndPart) {
  const Rings& rings = GetParam();
  const auto result =
      run_solids(3.0, 0.025,
                 {column(rings, "lower", 2, -1.0, speed), column(rings, "upper", 3, 0.002, -speed)},
                 touching("impact", "lower.face", "upper.face"));
  ASSERT_TRUE(result->completed());
  const bool is_explicit = rings.integrator.starts_with("central");
  const std::string axis = rings.dim == 3 ? "_z" : "_y";
  const double lower = result->measure("mean_velocity.lower.end" + axis);
  const double upper = result->measure("mean_velocity.upper.end" + axis);
  // Newton's method leaves 1e-9 of the forces
  EXPECT_NEAR(lower + upper, 0.0, speed * (is_explicit ? 1.0e-12 : 1.0e-8));
  // What became heat is no drift; the layer and the step leave 2.4e-4 of eight elements at most.
  EXPECT_NEAR(result->measure("energy.total.relative_drift_end"), 0.0, 1.0e-3);
  if (!rings.elastic) return;  // what has yielded parts slowly, and swings back once more
  EXPECT_EQ(result->times(RunEvent::Kind::contact_closed, "impact").size(), 1u);
  EXPECT_NEAR(lower, -speed, 0.07 * speed);  // eight elements disperse the front
  EXPECT_LE(result->measure("schwarz.iterations_max"),
            rings.material.starts_with("linear") ? 1 : 4);
}

TEST(SurfaceRingsRefused, BesideAPlaneBody) {
  Rings rings = all().front();
  SolidText flat = column(rings, "upper", 3, 0.002, -speed);
  flat.keys = "";
  flat.more = "";
  try {
    run_solids(0.1, 0.05, {column(rings, "lower", 2, -1.0, speed), flat},
               touching("impact", "lower.face", "upper.face"));
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is plane, but 'lower' is axisymmetric"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace abut::surfaces_of_rings_tests
