// Goal: faces of second-order elements are joined as exactly as their shape functions are, to each
// other and to first-order ones, on flat faces and on curved ones. Oracles: linear and quadratic
// fields, the energy identity, closed forms on curved joints with orders of convergence.

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include "subdomain_solver/fe/element.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_second_order_tests {
namespace {

using Words = std::vector<std::string>;

/// A static block of unit modulus and density with a port, joint, on one of its sides.
SolidText half(const std::vector<double>& lengths, const std::vector<int>& cells,
               const std::string& element, const std::string& joint) {
  return {.material = unit_law("linear_elastic", 0.3),
          .integrator = "quasi_static: {step: 1.0}",
          .position = {0.0},
          .port = "joint",
          .side = joint,
          .block = {lengths, cells, element}};
}

ResultPtr run(std::array<SolidText, 2> halves, double end = 1.0, double window = 1.0) {
  halves[0].name = "one";
  halves[1].name = "other";
  return run_solids(end, window, {halves[0], halves[1]}, joined("tie", "one.joint", "other.joint"));
}

/// Displacements that are prescribed wherever there is no joint, and what stress they mean.
struct Field {
  Words u = {};
  std::map<std::string, std::array<double, 2>> stress = {};  // least and greatest
};

std::string held(const Words& sides, const Field& field) {
  std::string out = "    constraints:\n";
  const Words axes = {"x", "y", "z"};
  for (const std::string& side : sides) {
    out += fmt::format("      at_{0}: {{on: {0}", side);
    for (std::size_t i = 0; i < field.u.size(); ++i)
      out += fmt::format(", {}: \"{}\"", axes[i], field.u[i]);
    out += "}\n";
  }
  return out;
}

/// Blocks of side 1, one beside the other; of rings one upon the other, from radius 1 on.
ResultPtr pass(const Words& elements, const std::array<int, 2>& across, const std::string& plane,
               const Field& field) {
  const std::size_t dim = field.u.size();
  const bool rings = plane == "axisymmetric";
  std::array<SolidText, 2> halves;
  for (const std::size_t k : {0u, 1u}) {
    const Words ends = rings ? Words{"bottom", "top"} : Words{"left", "right"};
    halves[k] = half(std::vector<double>(dim, 1.0), std::vector<int>(dim, across[k]), elements[k],
                     ends[1 - k]);
    const double along = static_cast<double>(k);
    halves[k].position = rings ? std::vector<double>{1.0, along} : std::vector<double>{along};
    if (dim == 2) halves[k].keys = fmt::format("plane: {}, ", plane);
    Words outer = rings ? Words{"left", "right"} : Words{"bottom", "top"};
    outer.push_back(ends[k]);
    if (dim == 3) outer.insert(outer.end(), {"back", "front"});
    halves[k].more = held(outer, field);
  }
  return run(halves);
}

void expect_stress(const RunResult& result, const Field& field) {
  ASSERT_TRUE(result.completed());
  EXPECT_EQ(result.measure("schwarz.iterations_max"), 2.0);
  for (const char* body : {"one", "other"}) {
    for (const auto& [component, ends] : field.stress) {
      const std::string name = fmt::format("body.{}.nodal_stress.{}.", body, component);
      EXPECT_NEAR(result.measure(name + "min"), ends[0], 1.0e-12) << name;  // of some 0.01
      EXPECT_NEAR(result.measure(name + "max"), ends[1], 1.0e-12) << name;
    }
  }
}

Field uniform(const std::vector<std::vector<double>>& gradient, const std::string& plane) {
  const std::size_t dim = gradient.size();
  const Words axes = {"x", "y", "z"}, names = {"xx", "xy", "zx", "", "yy", "yz", "", "", "zz"};
  Field field;
  const double mu = 0.5 / 1.3;
  double lambda = 0.3 / 1.3 / 0.4, trace = 0.0;
  if (plane == "stress") lambda = 2.0 * lambda * mu / (lambda + 2.0 * mu);
  for (std::size_t i = 0; i < dim; ++i) trace += gradient[i][i];
  if (plane == "axisymmetric") trace += gradient[0][0];
  for (std::size_t i = 0; i < dim; ++i) {
    Words terms;
    for (std::size_t j = 0; j < dim; ++j) {
      terms.push_back(fmt::format("({}) * {}", number(gradient[i][j]), axes[j]));
      if (j < i) continue;
      const double stress =
          mu * (gradient[i][j] + gradient[j][i]) + (i == j ? lambda * trace : 0.0);
      field.stress[names[3 * i + j]] = {stress, stress};
    }
    field.u.push_back(fmt::format("{}", fmt::join(terms, " + ")));
  }
  return field;
}

bool is_second_order(const std::string& element) { return element_named(element).order == 2; }

/// A linear field is at rest with any elements on either side, of faces of any ratio.
TEST(TiedSecondOrder, LinearFieldsPass) {
  const auto check = [](const Words& elements, const std::array<int, 2>& across,
                        const std::string& plane, const Field& field) {
    if (!is_second_order(elements[0]) && !is_second_order(elements[1])) return;
    SCOPED_TRACE(fmt::format("{} {} {}", fmt::join(elements, " "), fmt::join(across, ":"), plane));
    expect_stress(*pass(elements, across, plane, field), field);
  };
  const Words flat = {"quad4", "quad8", "quad9", "tri3", "tri6"};
  const Words space = {"hex8", "hex20", "tet4", "tet10"};
  const std::vector<std::vector<double>> plane = {{1.0e-2, 3.0e-3}, {-2.0e-3, 4.0e-3}};
  const std::vector<std::vector<double>> ring = {{4.0e-3, 0.0}, {0.0, 1.0e-2}};
  const std::vector<std::vector<double>> solid = {
      {1.0e-2, 3.0e-3, 1.0e-3}, {-2.0e-3, 4.0e-3, 2.0e-3}, {5.0e-4, -1.0e-3, -3.0e-3}};
  for (const std::string& one : flat) {
    for (const std::string& other : flat) {
      // 3:6: nodes of first order meet those of second order, and their facets are other ones
      for (const std::array<int, 2>& across : {std::array{3, 3}, {2, 5}, {5, 3}, {3, 6}, {6, 3}}) {
        check({one, other}, across, "strain", uniform(plane, "strain"));
        if (across != std::array{2, 5}) continue;
        check({one, other}, across, "stress", uniform(plane, "stress"));
        check({one, other}, across, "axisymmetric", uniform(ring, "axisymmetric"));
      }
    }
  }
  for (const std::string& one : space)
    for (const std::string& other : space)
      for (const std::array<int, 2>& across : {std::array{2, 2}, {1, 2}, {2, 1}, {2, 3}})
        check({one, other}, across, "", uniform(solid, ""));
}

/// Bending: displacements of second order, stress that is linear along the joint. Rows of linear
/// functions leave nothing of it over.
TEST(TiedSecondOrder, BendingPasses) {
  const double nu = 0.3, k = 0.01;
  Field plane{.u = {fmt::format("{} * x * y", number(k * (1 - nu * nu))),
                    fmt::format("{} * x^2 - {} * y^2", number(-0.5 * k * (1 - nu * nu)),
                                number(0.5 * k * nu * (1 + nu)))},
              .stress = {{"xx", {0.0, k}}, {"yy", {0.0, 0.0}}, {"xy", {0.0, 0.0}}}};
  Field solid{.u = {fmt::format("{} * x * y", number(k)),
                    fmt::format("{} * (x^2 + {} * (y^2 - z^2))", number(-0.5 * k), number(nu)),
                    fmt::format("{} * y * z", number(-nu * k))},
              .stress = {{"xx", {0.0, k}}, {"yy", {0.0, 0.0}}, {"zx", {0.0, 0.0}}}};
  for (const std::string one : {"quad8", "quad9", "tri6"}) {
    for (const std::string other : {"quad8", "quad9", "tri6"}) {
      for (const std::array<int, 2>& across : {std::array{2, 5}, {5, 3}}) {
        SCOPED_TRACE(fmt::format("{} {} {}", one, other, fmt::join(across, ":")));
        expect_stress(*pass({one, other}, across, "strain", plane), plane);
      }
    }
  }
  for (const std::string one : {"hex20", "tet10"}) {
    for (const std::string other : {"hex20", "tet10"}) {
      SCOPED_TRACE(fmt::format("{} {}", one, other));
      expect_stress(*pass({one, other}, {1, 2}, "", solid), solid);
    }
  }
}

/// Two halves of a bar that shake in all directions, the other one in finer steps.
ResultPtr shaken(const Words& elements, const std::array<int, 2>& across,
                 const std::string& schemes, double ratio, std::size_t dim) {
  std::array<SolidText, 2> halves;
  for (const std::size_t k : {0u, 1u}) {
    std::vector<double> lengths(dim, 0.5);
    std::vector<int> cells(dim, across[k]);
    lengths[0] = 1.0;
    cells[0] = 2 * across[k];
    halves[k] = half(lengths, cells, elements[k], k == 0 ? "right" : "left");
    halves[k].position = {static_cast<double>(k)};
    // half the stable step of the finest mesh here
    halves[k].integrator = scheme_named(schemes[k], k == 0 ? 0.01 : 0.01 / ratio);
    halves[k].field = fmt::format("\"0.5*cos(_pi/2*x)*(1 + y)\", \"0.3*sin(_pi/2*x)\"{}",
                                  dim == 2 ? "" : ", \"0.2*y*cos(_pi/2*x)\"");
  }
  return run(halves, 1.0, 0.1);
}

/// Energy and momentum are kept for any schemes and steps, in one call per window.
TEST(TiedSecondOrder, EnergyIsAnIdentityInOneCallPerWindow) {
  const auto check = [](const Words& elements, const std::array<int, 2>& across,
                        const std::string& schemes, double ratio, std::size_t dim) {
    SCOPED_TRACE(fmt::format("{} {} {} {}", fmt::join(elements, " "), schemes, ratio, dim));
    const auto result = shaken(elements, across, schemes, ratio, dim);
    ASSERT_TRUE(result->completed());
    // Rounding of 100 steps of each body; momenta are some 0.1.
    EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, 1.0e-13);
    EXPECT_LE(result->measure("momentum.total"), 1.0e-12);  // of some 0.1, rounding of 100 steps
    EXPECT_EQ(result->measure("schwarz.iterations_max"), 2.0);  // the first window has no trial
    EXPECT_NEAR(result->measure("schwarz.iterations_mean"), 1.1, 1.0e-12);  // ten windows
  };
  const std::vector<Words> flat = {{"quad8", "quad8"}, {"quad8", "quad4"}, {"tri3", "tri6"}};
  for (const std::string schemes : {"II", "IE", "EI", "EE"}) {
    for (const Words& elements : flat) {
      check(elements, {2, 4}, schemes, 1.0, 2);
      check(elements, {4, 3}, schemes, 7.3, 2);
    }
    check({"hex20", "tet10"}, {1, 2}, schemes, 1.5, 3);
    check({"hex8", "hex20"}, {2, 1}, schemes, 1.5, 3);
  }
}

/// [J/m] energy of the tubes below: displacements A r + B / r in either, with no stress outside,
/// the pressure 0.01 inside, and both alike between them (Lame, plane strain).
double lame_energy() {
  const double nu = 0.3, pressure = 0.01, a = 0.5, b = 1.0, c = 2.0;
  const auto lambda = [nu](double modulus) { return modulus * nu / (1 + nu) / (1 - 2 * nu); };
  const auto mu = [nu](double modulus) { return 0.5 * modulus / (1 + nu); };
  // Radial stress 2 (lambda + mu) A - 2 mu B / r^2.
  const auto bulk = [&](double modulus) { return 2 * (lambda(modulus) + mu(modulus)); };
  Eigen::Matrix4d m;
  m << bulk(1.0), -2 * mu(1.0) / (a * a), 0.0, 0.0,                          //
      b, 1 / b, -b, -1 / b,                                                  //
      bulk(1.0), -2 * mu(1.0) / (b * b), -bulk(3.0), 2 * mu(3.0) / (b * b),  //
      0.0, 0.0, bulk(3.0), -2 * mu(3.0) / (c * c);
  const Eigen::Vector4d at = m.inverse() * Eigen::Vector4d(-pressure, 0.0, 0.0, 0.0);
  return 0.5 * pressure * (at[0] * a + at[1] / a) * 0.5 * std::numbers::pi * a;
}

/// A tool that stands holds every node of a face, as a support does.
TEST(TiedSecondOrder, ToolsHoldEveryNode) {
  const std::string load = "    loads: {pull: {on: right, traction: [\"0.01\", \"0.002\"]}}\n";
  for (const std::string element : {"quad8", "tri6"}) {
    SCOPED_TRACE(element);
    SolidText body = half({1.0, 1.0}, {3, 3}, element, "left");
    body.name = "one";
    body.more = load;
    const SolidText tool{.name = "tool",
                         .position = {-1.0},
                         .model = "rigid_tool",
                         .keys = "way: [\"0\", \"0\"], ",
                         .sides = {"right"},
                         .block = {{1.0, 1.0}, {2, 2}, "quad8"}};
    const auto tied = run_solids(1.0, 1.0, {body, tool}, joined("tie", "one.joint", "tool.right"));
    body.more += "    constraints: {clamp: {on: left, fixed: true}}\n";
    const auto held = run_solids(1.0, 1.0, {body});
    ASSERT_TRUE(tied->completed());
    for (const char* what : {"nodal_stress.xx.max", "nodal_stress.xy.max", "displacement.y.max"}) {
      const std::string measure = fmt::format("body.one.{}", what);
      EXPECT_NEAR(tied->measure(measure), held->measure(measure), 1.0e-12);  // of some 0.01
    }
  }
}

/// Unlike meshes move as exactly as one mesh of the coarser cells: the joint adds nothing. Straight
/// facets left some six times as much.
TEST(TiedSecondOrder, MovesAsExactlyAsOneMesh) {
  const std::vector<std::string> what = {"one.joint.displacement.x", "one.joint.displacement.y",
                                         "other.displacement.x.max", "other.displacement.y.max"};
  const auto moved = [&what](const std::array<int, 2>& across) {
    const auto result = shaken({"quad8", "quad8"}, across, "II", 1.0, 2);
    std::vector<double> at;
    for (const std::string& measure : what) at.push_back(result->measure("body." + measure));
    return at;
  };
  const std::vector<double> exact = moved({16, 16});  // nodes on nodes: one mesh
  const auto error = [&exact, &moved](const std::array<int, 2>& across) {
    return largest_difference(moved(across), exact);
  };
  for (const int n : {2, 4}) {
    const double coarse = error({n, n});
    EXPECT_LE(error({n, 3 * n / 2}), 1.05 * coarse) << n;
    EXPECT_LE(error({3 * n / 2, n}), 1.05 * coarse) << n;
  }
}

/// Tubes, one in the other, under pressure inside, a quarter of them: stored energy over Lame's.
/// Radii 1/2, 1, 2; moduli 1 and 3.
double tube_error(const Words& elements, const std::vector<std::vector<int>>& cells) {
  const std::size_t dim = cells[0].size();
  std::array<SolidText, 2> halves;
  for (const std::size_t k : {0u, 1u}) {
    std::vector<double> lengths = {std::numbers::ln2, 1.0};
    if (dim == 3) lengths.push_back(0.25);
    halves[k] = half(lengths, cells[k], elements[k], k == 0 ? "right" : "left");
    halves[k].keys =
        fmt::format("map: [\"{0}*exp(x)*cos(_pi/2*y)\", \"{0}*exp(x)*sin(_pi/2*y)\"{1}], ",
                    number(k == 0 ? 0.5 : 1.0), dim == 3 ? ", \"z\"" : "");
    halves[k].material =
        fmt::format("linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.3, density: 1.0}}",
                    k == 0 ? "1.0" : "3.0");
    halves[k].more =
        fmt::format("    constraints: {{low: {{on: bottom, y: 0}}, high: {{on: top, x: 0}}{}}}\n",
                    dim == 3 ? ", back: {on: back, z: 0}, front: {on: front, z: 0}" : "");
  }
  halves[0].more += "    loads: {inside: {on: left, pressure: \"0.01\"}}\n";
  const auto result = run(halves);
  EXPECT_TRUE(result->completed());
  const double stored =
      result->measure("body.one.energy.stored") + result->measure("body.other.energy.stored");
  return std::abs(stored / (lame_energy() * (dim == 3 ? 0.25 : 1.0)) - 1.0);
}

/// Curved joints of unlike meshes leave the order of the elements: four of the energy. Joined by
/// straight facets it was one, and the error 1e-3.
TEST(TiedSecondOrder, CurvedJointsKeepTheOrder) {
  const auto check = [](const Words& elements, const std::vector<std::vector<int>>& cells,
                        int refined, double allowed) {
    SCOPED_TRACE(fmt::format("{} {}", fmt::join(elements, " "), cells[0].size()));
    std::vector<std::vector<int>> fine = cells;
    for (std::vector<int>& body : fine)
      for (int& count : body) count *= refined;
    const double coarse_error = tube_error(elements, cells),
                 fine_error = tube_error(elements, fine);
    EXPECT_LE(fine_error, allowed);
    EXPECT_GT(observed_order(coarse_error, fine_error, refined), 3.8);
  };
  for (const Words& elements : {Words{"quad8", "quad8"}, {"quad8", "tri6"}, {"tri6", "quad8"}}) {
    check(elements, {{2, 4}, {2, 6}}, 2, 4.0e-6);  // measured 3.1e-6 and 6e-7
    check(elements, {{2, 6}, {4, 4}}, 2, 4.0e-6);
  }
  for (const Words& elements : {Words{"hex20", "hex20"}, {"tet10", "hex20"}, {"tet10", "tet10"}})
    check(elements, {{1, 2, 1}, {1, 3, 2}}, 2, 6.0e-5);  // measured 5.0e-5
}

}  // namespace
}  // namespace abut::tied_second_order_tests
