// Goal: a body that was made from other data than the coordinator's is told from its own. Oracle:
// descriptions that differ in one thing.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "coordinator/same_body.hpp"

namespace abut {
namespace {

Description block() {
  Description body;
  body.name = "block";
  body.model = "fe on block.msh (digest 00000000000000aa), 48 tet10, newmark, step 1e-06 s";
  body.dim = 3;
  body.dofs = 360;
  body.mass = 6000.0;
  return body;
}

TEST(SameBody, OfEqualDataHasNoDifference) {
  Description theirs = block();
  theirs.mass *= 1.0 + 1.0e-14;  // another machine's last bit
  EXPECT_EQ(difference_of(block(), theirs), "");
  Description wall = block();
  wall.mass = std::numeric_limits<double>::infinity();
  EXPECT_EQ(difference_of(wall, wall), "");
}

TEST(SameBody, IsToldByWhatDiffers) {
  const auto differ = [](auto change) {
    Description theirs = block();
    change(theirs);
    return difference_of(block(), theirs);
  };
  EXPECT_EQ(differ([](Description& d) { d.dim = 2; }), "it has 2 dimensions, here it has 3");
  EXPECT_EQ(differ([](Description& d) { d.dofs = 363; }),
            "it has 363 degrees of freedom, here it has 360");
  EXPECT_EQ(differ([](Description& d) { d.mass = 6001.0; }),
            "its mass is 6001 kg, here it is 6000 kg");
  EXPECT_NE(differ([](Description& d) { d.model[27] = 'b'; }), "");
  EXPECT_NE(differ([](Description& d) { d.mass = std::numeric_limits<double>::infinity(); }), "");
}

}  // namespace
}  // namespace abut
