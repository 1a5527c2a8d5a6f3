// Goal: a body tells how much of what presses is held by friction. Oracles: what may not slip
// sticks all over, what does not rub or is drawn along nowhere, and of a face on two tools the part
// on the rough one.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::sticking_areas_tests {
namespace {

constexpr int cells = 8;

/// A block of edges 1, pressed by its top onto tools by 1e-4 while `way` draws it along.
SolidText block(int dim, const std::string& way) {
  const std::string up = dim == 2 ? "y" : "z", top = dim == 2 ? "top" : "front";
  return {.name = "block",
          .dim = dim,
          .mesh = dim == 2 ? block_mesh({1.0, 0.5}, {cells, 2})
                           : block_mesh({1.0, 1.0, 0.5}, {cells, 2, 2}),
          .material = unit_law("linear_elastic", 0.0),
          .integrator = "quasi_static: {step: 0.5}",
          .side = dim == 2 ? "bottom" : "back",
          .keys = dim == 2 ? "thickness: 0.7, " : "",
          .more = fmt::format("    constraints: {{end: {{on: {}, x: '{}', {}{}: '-1e-4 * min(t, "
                              "1)'}}}}\n",
                              top, way, dim == 3 ? "y: '0', " : "", up)};
}

SolidText tool(const std::string& name, int dim, double from, double to) {
  SolidText text{.name = name,
                 .dim = dim,
                 .mesh = dim == 2 ? block_mesh({to - from, 0.5}, {1, 1})
                                  : block_mesh({to - from, 2.0, 0.5}, {1, 1, 1}),
                 .position = dim == 2 ? std::vector{from, -0.5} : std::vector{from, -0.5, -0.5},
                 .side = dim == 2 ? "top" : "front",
                 .model = "rigid_tool"};
  return text;
}

std::string on(const std::string& name, const std::string& friction) {
  return fmt::format("  {0}: {{sides: [block.face, {0}.face], contact: {{friction: {1}}}}}\n", name,
                     friction);
}

double stick(const RunResult& result) {
  return result.measure("body.block.face.contact.stick_area");
}
double area(const RunResult& result) { return result.measure("body.block.face.contact.area"); }

TEST(StickingArea, IsAllOfWhatMayNotSlipAndNoneOfWhatSlides) {
  for (const int dim : {2, 3}) {
    const double face = dim == 2 ? 0.7 : 1.0;
    const auto run = [dim](const std::string& friction, const std::string& way) {
      auto result = run_solids(2.0, 0.5, {block(dim, way), tool("floor", dim, -1.0, 2.0)},
                               on("floor", friction));
      EXPECT_TRUE(result->completed());
      return result;
    };
    const std::string aside = "4e-5 * max(t - 1, 0)", little = "1e-6 * max(t - 1, 0)";
    const auto rough = run("rough", aside), held = run("0.1", little), slides = run("0.1", aside),
               smooth = run("0", aside);
    // The face deforms by 1e-4 at most.
    for (const auto* result : {&rough, &held, &slides, &smooth})
      EXPECT_NEAR(area(**result), face, 2.0e-4 * face) << dim;
    EXPECT_EQ(stick(*rough), area(*rough)) << dim;
    EXPECT_EQ(stick(*held), area(*held)) << dim;
    EXPECT_EQ(stick(*slides), 0.0) << dim;
    EXPECT_EQ(stick(*smooth), 0.0) << dim;
  }
}

TEST(StickingArea, IsThePartThatIsOnARoughTool) {
  for (const int dim : {2, 3}) {
    const double face = dim == 2 ? 0.7 : 1.0;
    const auto result = run_solids(2.0, 0.5,
                                   {block(dim, "1e-5 * max(t - 1, 0)"),
                                    tool("rough", dim, -1.0, 0.5), tool("smooth", dim, 0.5, 2.0)},
                                   on("rough", "rough") + on("smooth", "0"));
    ASSERT_TRUE(result->completed());
    // Area is that of nodes; the one on the border belongs to either side.
    EXPECT_NEAR(stick(*result), 0.5 * face, 0.51 / cells * face) << dim;
    EXPECT_NEAR(area(*result), face, 2.0e-4 * face) << dim;
  }
}

}  // namespace
}  // namespace abut::sticking_areas_tests
