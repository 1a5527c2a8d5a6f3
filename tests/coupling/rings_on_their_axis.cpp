// Goal: all of the outside of a body of revolution that reaches its axis is a port, wherever the
// body lives. Oracle: normals that other processes accept are of length 1.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

TEST(RingsOnTheirAxis, LookSomewhereAtEveryPoint) {
  for (const std::string model : {"fe", "rigid_tool"}) {
    for (const char* element : {"quad4", "quad8", "tri3"}) {
      SolidText disk{.name = "disk",
                     .port = "skin",
                     .side = "boundary",
                     .model = model,
                     .keys = "plane: axisymmetric, ",
                     .block = block_in(2, {1.0, 1.0}, {2, 3}, element)};
      if (model == "fe") {
        disk.material = unit_law("linear_elastic", 0.3);
        disk.integrator = "newmark: {step: 1.0}";
      }
      const std::unique_ptr<Subdomain> body = build(disk);
      const PortGeometry& skin = body->describe().ports[0].geometry;
      for (std::size_t k = 0; k < skin.normals.size(); k += 2) {
        const double length = std::hypot(skin.normals[k], skin.normals[k + 1]);
        EXPECT_NEAR(length, 1.0, 1.0e-12) << model << ' ' << element << ' ' << k / 2;  // rounding
        if (skin.points[k] == 0.0 && skin.points[k + 1] > 0.0 && skin.points[k + 1] < 1.0) {
          EXPECT_EQ(skin.normals[k], -1.0);  // to where no ring is
        }
      }
    }
  }
}

}  // namespace
}  // namespace abut
