// Goal: what is far from a contact neither gives way by a kernel nor changes anything. Oracle: a
// partner that is linear is predicted exactly wherever it gives way, so that one sweep is enough
// while the contact grows, moves and leaves the points that its first zone had; and a wider plate
// acts like a narrow one until waves come back from its rim.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::surfaces_with_zones_tests {
namespace {

/// A disk that falls on a plate, along it too.
ResultPtr run(double width, const std::string& of_disk, const std::string& of_plate, double along) {
  const SolidText disk{.name = "disk",
                       .mesh = "disk: {radius: 0.25, core: 4, layers: 3}",
                       .material = unit_law("linear_elastic", 0.3),
                       .integrator = of_disk,
                       .position = {0.0, 0.262},
                       .velocity = {along, -0.02},
                       .port = "skin",
                       .side = "boundary"};
  const SolidText plate{.name = "plate",
                        .mesh = block_mesh({width, 0.5}, {static_cast<int>(12.0 * width), 6}),
                        .material = unit_law("linear_elastic", 0.3),
                        .integrator = of_plate,
                        .position = {-0.5 * width, -0.5},
                        .side = "top"};
  return run_solids(2.0, 0.08, {disk, plate}, touching("impact", "disk.skin", "plate.face"));
}

TEST(ContactZone, HoldsWhatContactReaches) {
  const std::string leapfrog = "central_difference: {step: 0.01}", slow = "newmark: {step: 0.02}";
  for (const auto& [disk, plate] :
       {std::pair(leapfrog, leapfrog), std::pair(leapfrog, slow), std::pair(slow, leapfrog)}) {
    for (const double along : {0.0, 0.2}) {  // 0.4 in all, five facets
      const auto narrow = run(3.0, disk, plate, along);
      const auto wide = run(12.0, disk, plate, along);
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
}  // namespace abut::surfaces_with_zones_tests
