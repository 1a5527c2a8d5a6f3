// Goal: symmetry of a side is no displacement normal to it.
// Oracles: the components and directions that say the same; the words of refusals.

#include <string>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_constraints_tests {
namespace {

std::unique_ptr<Subdomain> solid(const std::string& mesh, const std::string& constraints) {
  SolidText part{.name = "part", .mesh = mesh, .material = unit_law("linear_elastic", 0.3)};
  if (mesh.starts_with("box")) part.dim = 3;
  part.integrator = "quasi_static: {step: 1.0}";
  part.more = fmt::format("    constraints: {{{}}}\n    body_force: {}\n", constraints,
                          components({0.3, -0.2, 0.1}, part.dim));
  return build(part);
}

/// State after one step.
std::uint64_t settled(const std::string& mesh, const std::string& constraints) {
  const std::unique_ptr<Subdomain> body = solid(mesh, constraints);
  Response response;
  step(*body, free_request(*body, 0.0, 1.0), response);
  return body->state_hash();
}

const std::string cube = "box: {lengths: [1.0, 1.0, 1.0], elements: [2, 2, 2]}";

TEST(Symmetry, OfSidesAlongAxesIsAComponentOfEach) {
  EXPECT_EQ(settled(cube,
                    "a: {on: left, symmetry: true}, b: {on: bottom, symmetry: true}, "
                    "c: {on: back, symmetry: true}"),
            settled(cube, "a: {on: left, x: '0'}, b: {on: bottom, y: '0'}, c: {on: back, z: '0'}"));
}

TEST(Symmetry, SharesNodesWithOtherConstraints) {
  EXPECT_EQ(settled(cube, "a: {on: left, fixed: true}, b: {on: bottom, symmetry: true}"),
            settled(cube, "a: {on: left, fixed: true}, b: {on: bottom, y: '0'}"));
}

TEST(Symmetry, OfAnInclinedSideIsARollerAlongIt) {
  RectangleMesh square;
  square.lengths = {1.0, 1.0};
  square.elements = {3, 3};
  Mesh mesh = generate(square, "test");
  const double c = std::cos(0.5), s = std::sin(0.5);
  for (std::size_t k = 0; k < mesh.points.size(); k += 2) {
    const double x = mesh.points[k], y = mesh.points[k + 1];
    mesh.points[k] = c * x - s * y;
    mesh.points[k + 1] = s * x + c * y;
  }
  const Document document = Document::from_text("test", "bodies: {}\n");
  BodySpec spec;
  ConstraintSpec mirror;
  mirror.on = "left";  // outward normal (-c, -s)
  mirror.symmetry = true;
  spec.constraints.push_back({"mirror", mirror});
  const Constraints made = make_constraints(spec, {document, "bodies.part"}, mesh);
  const std::vector<std::int32_t> nodes = mesh.nodes_of("left");
  ASSERT_EQ(made.frames.size(), nodes.size());
  ASSERT_EQ(made.supports.size(), nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    EXPECT_EQ(made.supports[k].dof, 2 * nodes[k]);  // the first axis of the node's own frame
    EXPECT_EQ(made.supports[k].value(0.3), 0.0);
    const Eigen::Vector3d first = made.frames[k].axes.col(0);
    EXPECT_NEAR(std::abs(first(0) * c + first(1) * s), 1.0, roundoff(20.0, 1.0));
  }
}

std::string refused(const std::string& mesh, const std::string& constraints) {
  return refusal([&] { solid(mesh, constraints); });
}

TEST(Symmetry, OfACurvedSideIsRefused) {
  const std::string disk = "disk: {radius: 1.0, core: 2, layers: 2}";
  expect_words(refused(disk, "a: {on: mantle, symmetry: true}"),
               {"constraints.a.on: is not plane: node "});
}

TEST(Symmetry, IsOneWayToPrescribe) {
  expect_words(refused(cube, "a: {on: left, symmetry: true, x: '0'}"), {"in more than one way"});
}

}  // namespace
}  // namespace abut::solver_constraints_tests
