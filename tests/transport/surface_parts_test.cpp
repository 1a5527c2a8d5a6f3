// Goal: surfaces of second-order elements arrive as they were sent, and parts that fit no element
// are refused by name. Oracle: what arrived; the words of the error.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "messaging/codec/parts.hpp"

namespace abut::surface_parts_test {
namespace {

/// Two facets of three nodes each in the plane, divided at their middles.
PortGeometry edge() {
  PortGeometry port;
  port.dim = 2;
  port.points = {0, 0, 2, 0, 1, 0, 4, 0, 3, 0};
  port.normals.assign(10, 0.0);
  port.facets = {0, 2, 2, 1, 1, 4, 4, 3};
  port.offsets = {0, 2, 4, 6, 8};
  port.parts = {2, 2};
  return port;
}

TEST(SurfaceParts, ArriveAndAreRefusedWhereTheyDoNotFit) {
  const auto told = [](const std::vector<std::int32_t>& parts) -> std::string {
    PortGeometry port = edge(), got;
    port.parts = parts;
    v1::Surface wire;
    encode(port, wire);
    try {
      decode(wire, FieldPath{nullptr, "surface"}, got);
    } catch (const CodecError& error) {
      return error.what();
    }
    EXPECT_EQ(got.parts, parts);
    return "accepted";
  };
  for (const std::vector<std::int32_t>& parts :
       {std::vector<std::int32_t>{}, {2, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 1, 1}})
    EXPECT_EQ(told(parts), "accepted");
  EXPECT_EQ(told({4}), "surface.parts names a facet of 4 parts");
  EXPECT_EQ(told({2, 2, 1}), "surface.parts names more than there are");
  EXPECT_EQ(told({2}), "surface.parts names 2 of 4");
  EXPECT_EQ(told({0, 2, 2}), "surface.parts names a facet of 0 parts");
}

}  // namespace
}  // namespace abut::surface_parts_test
