// Goal: what is far from a contact neither gives way by a kernel nor changes anything. Oracle: a
// partner that is linear is predicted exactly wherever it gives way, so that one sweep is enough
// while the contact grows, moves and leaves the points that its first zone had; and a wider plate
// acts like a narrow one until waves come back from its rim.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// A disk that falls on a plate, along it too.
std::string text(double width, const std::string& disk, const std::string& plate, double along) {
  return fmt::format(
      "meta: {{title: test}}\ntime: {{begin: 0.0, end: 2.0, window: 0.08}}\nbodies:\n"
      "  disk:\n    model: {{fe: {{dimension: 2, mesh: {{disk: {{radius: 0.25, core: 4, layers: "
      "3}}}}}}}}\n"
      "    material: {{linear_elastic: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: "
      "1.0}}}}\n"
      "    integrator: {{{}}}\n    initial: {{position: [0.0, 0.262], velocity: [{}, -0.02]}}\n"
      "    ports: {{skin: {{side: boundary}}}}\n"
      "  plate:\n    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [{}, 0.5], "
      "elements: [{}, 6]}}}}}}}}\n"
      "    material: {{linear_elastic: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: "
      "1.0}}}}\n"
      "    integrator: {{{}}}\n    initial: {{position: [{}, -0.5]}}\n"
      "    ports: {{face: {{side: top}}}}\n"
      "interfaces: {{impact: {{sides: [disk.skin, plate.face], contact: {{}}}}}}\n",
      disk, number(along), number(width), number(width * 12.0), plate, number(-0.5 * width));
}

TEST(ContactZone, HoldsWhatContactReaches) {
  const std::string leapfrog = "central_difference: {step: 0.01}", slow = "newmark: {step: 0.02}";
  for (const auto& [disk, plate] : {std::pair(leapfrog, leapfrog), std::pair(leapfrog, slow),
                                    std::pair(slow, leapfrog)}) {
    for (const double along : {0.0, 0.2}) {  // 0.4 in all, five facets
      const auto narrow = run_document(Document::from_text("test", text(3.0, disk, plate, along)));
      const auto wide = run_document(Document::from_text("test", text(12.0, disk, plate, along)));
      for (const auto* result : {narrow.get(), wide.get()}) {
        ASSERT_TRUE(result->completed());
        EXPECT_EQ(result->measure("schwarz.iterations_max"), 1.0) << disk << plate << along;
        EXPECT_EQ(result->times(RunEvent::Kind::contact_closed, "impact").size(), 1u);
      }
      // Waves take 3 from the middle of the narrow plate to its rim and back: what differs is what
      // sweeps leave, 1e-6 of a step's way (2e-8 measured); an implicit step sends a little of
      // everything everywhere.
      const double least = disk == leapfrog && plate == leapfrog ? 1.0e-6 : 1.0e-3;
      EXPECT_NEAR(wide->measure("contact.impact.impulse"),
                  narrow->measure("contact.impact.impulse"),
                  least * narrow->measure("contact.impact.impulse"));
    }
  }
}

}  // namespace
}  // namespace abut
