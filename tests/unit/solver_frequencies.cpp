// Goal: a body in modes tells its natural frequencies. Oracle: the frequencies of a row of equal
// elements with consistent mass, in closed form (Hughes, The Finite Element Method, section 9.1).

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_frequencies_tests {
namespace {

std::unique_ptr<Subdomain> bar(const std::string& model, const std::string& keys,
                               const std::string& constraints = "") {
  return build(
      SolidText{.name = "bar",
                .dim = 1,
                .mesh = "bar: {length: 2.0, elements: 20, area: 0.5}",
                .material = bar_law(9.0, 1.0),
                .integrator = "newmark: {step: 0.01, mass: consistent}",
                .model = model,
                .keys = keys,
                .more = "    loads: {end: {on: right, traction: [\"0\"]}}\n" + constraints});
}

/// [Hz] of the wave that turns by this angle from node to node; wave speed 3 m/s, cells of 0.1 m.
double hertz(double angle) {
  const double square = 6.0 * (1.0 - std::cos(angle)) / (2.0 + std::cos(angle));
  return 3.0 / 0.1 * std::sqrt(square) / (2.0 * std::numbers::pi);
}

TEST(ModalBody, TellsItsFrequenciesInHertz) {
  const std::unique_ptr<Subdomain> clamped =
      bar("modal", "modes: 5, ", "    constraints: {wall: {on: left, fixed: true}}\n");
  const std::vector<double>& found = clamped->describe().frequencies;
  ASSERT_EQ(found.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    const double exact = hertz((static_cast<double>(k) + 0.5) * std::numbers::pi / 20.0);
    EXPECT_NEAR(found[k], exact, roundoff(1.0e5, exact)) << k;  // squares are 1e3 apart
  }
  const std::unique_ptr<Subdomain> loose = bar("modal", "modes: 3, ");
  const std::vector<double>& of_free = loose->describe().frequencies;
  ASSERT_EQ(of_free.size(), 4U);
  EXPECT_EQ(of_free[0], 0.0);  // it moves as a whole
  for (std::size_t k = 1; k < 4; ++k) {
    const double exact = hertz(static_cast<double>(k) * std::numbers::pi / 20.0);
    EXPECT_NEAR(of_free[k], exact, roundoff(1.0e5, exact)) << k;
  }
}

TEST(ModalBody, AloneTellsFrequencies) {
  EXPECT_TRUE(bar("fe", "")->describe().frequencies.empty());
}

}  // namespace
}  // namespace abut::solver_frequencies_tests
