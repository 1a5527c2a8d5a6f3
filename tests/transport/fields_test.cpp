// Goal: grid and fields of a body elsewhere are those of the body, asked for in the state that the
// caller means; what does not fit the description or the grid is refused by name.
// Oracle: bit-equal values; for unsound replies the text of the error.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "tests/transport/loop.hpp"

namespace abut::fields_test {
namespace {

std::string error_of(const std::function<void()>& act) { return run_error(act, true); }

TEST(RemoteFields, AreThoseOfTheBody) {
  ConfiguredLoop loop;
  advance_once(loop);
  const Grid grid = loop.body.grid(), local = loop.fake->grid();
  EXPECT_EQ(grid.points, local.points);
  EXPECT_EQ(grid.types, local.types);
  EXPECT_EQ(grid.connectivity, local.connectivity);
  EXPECT_EQ(grid.offsets, local.offsets);
  const std::vector<FieldValues> values = loop.body.fields();
  EXPECT_EQ(values, loop.fake->fields());
  EXPECT_NE(values[0][0], 0.0);
}

TEST(RemoteFields, TheGridIsAskedForOnceAndFieldsEveryTime) {
  ConfiguredLoop loop;
  for (int i = 0; i < 3; ++i) loop.body.fields();
  EXPECT_EQ(loop.fake->counts.grids, 1);
  EXPECT_EQ(loop.fake->counts.fields, 3);
}

TEST(RemoteFields, APendingRestoreIsDoneFirst) {
  ConfiguredLoop loop;
  const std::vector<FieldValues> begin = loop.body.fields();
  loop.body.save();
  advance_once(loop);
  EXPECT_NE(loop.body.fields(), begin);
  loop.body.restore();
  EXPECT_EQ(loop.body.fields(), begin);
}

TEST(RemoteFields, WhatDoesNotFitIsRefusedByName) {
  ConfiguredLoop loop;
  const std::string fault = " | this is a fault of the solver, not of the scene";
  loop.fake->spoil_grid = [](Grid& grid) { grid.connectivity[0] = 1; };
  EXPECT_EQ(error_of([&] { loop.body.grid(); }),
            "body 'fake' gave no sound answer to grid (request 2): grid is unsound: a cell of the "
            "grid has a node that is not there" +
                fault);
  loop.fake->spoil_grid = nullptr;
  loop.fake->spoil_fields = [](std::vector<FieldValues>& values) { values[0].pop_back(); };
  EXPECT_EQ(error_of([&] { loop.body.fields(); }),
            "body 'fake' gave no sound answer to fields (request 4): fields is unsound: field "
            "displacement has 2 numbers where 3 belong" +
                fault);
  loop.fake->spoil_fields = [](std::vector<FieldValues>& values) { values.push_back({}); };
  EXPECT_EQ(error_of([&] { loop.body.fields(); }),
            "body 'fake' gave no sound answer to fields (request 5): fields is unsound: 2 fields "
            "came where the description lists 1" +
                fault);
}

TEST(RemoteFields, ValuesThatAreNotFinitePassToWhoeverNamesTheNode) {
  ConfiguredLoop loop;
  loop.fake->spoil_fields = [](std::vector<FieldValues>& values) {
    values[0][1] = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_TRUE(std::isnan(loop.body.fields()[0][1]));
}

TEST(RemoteFields, AReplyAboveTheFrameLimitSaysWhatHelps) {
  ConfiguredLoop loop(1000);
  loop.fake->spoil_grid = [](Grid& grid) { grid.points.resize(300, 0.0); };
  const std::string error = error_of([&] { loop.body.grid(); });
  EXPECT_NE(error.find("above the limit of 1000"), std::string::npos) << error;
  EXPECT_NE(error.find("leave out output.fields, take a coarser mesh, or run with --local"),
            std::string::npos)
      << error;
}

TEST(RemoteFields, ADescriptionWithUnsoundFieldsIsRefused) {
  Description body = FakeSubdomain().describe();
  body.fields.push_back(body.fields[0]);
  v1::Description wire;
  encode(body, wire);
  const auto refusal = [&wire] {
    try {
      Description got;
      decode(wire, got);
    } catch (const CodecError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(), "description.fields is unsound: two fields have the name displacement");
  wire.mutable_fields(1)->set_place(v1::FIELD_PLACE_UNSPECIFIED);
  EXPECT_EQ(refusal(), "description.fields[1].place has an unknown value");
}

}  // namespace
}  // namespace abut::fields_test
