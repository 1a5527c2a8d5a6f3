// Goal: every way in which a list of fields, a grid or values can be unsound has its words.
// Oracle: the words, and silence for what is sound.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "contract/field.hpp"

namespace abut::contract_field_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two line cells in a row.
Grid row() { return {{0, 0, 0, 1, 0, 0, 2, 0, 0}, {3, 3}, {0, 1, 1, 2}, {0, 2, 4}}; }

const std::vector<FieldInfo> described{{"velocity", FieldPlace::nodes, 3},
                                       {"density", FieldPlace::cells, 1}};

TEST(Field, UnsoundListsAreNamed) {
  EXPECT_EQ(unsound(described), "");
  std::vector<FieldInfo> fields = described;
  fields[1].name = "velocity";
  EXPECT_EQ(unsound(fields), "two fields have the name velocity");
  fields[1] = {"", FieldPlace::nodes, 1};
  EXPECT_EQ(unsound(fields), "a field has no name");
  fields[1] = {"flow", FieldPlace::nodes, 0};
  EXPECT_EQ(unsound(fields), "field flow has 0 components");
}

TEST(Field, UnsoundGridsAreNamed) {
  EXPECT_EQ(unsound(row()), "");
  EXPECT_EQ(unsound(Grid{{}, {}, {}, {0}}), "");
  const auto spoilt = [](const std::function<void(Grid&)>& spoil) {
    Grid grid = row();
    spoil(grid);
    return unsound(grid);
  };
  EXPECT_EQ(spoilt([](Grid& g) { g.points.pop_back(); }), "the grid has no whole number of points");
  EXPECT_EQ(spoilt([](Grid& g) { g.points[4] = infinity; }), "point 1 of the grid is not finite");
  EXPECT_EQ(spoilt([](Grid& g) { g.offsets.pop_back(); }),
            "the grid has 2 offsets for 2 cells, or they do not begin with 0");
  EXPECT_EQ(spoilt([](Grid& g) { g.offsets.clear(); }),
            "the grid has 0 offsets for 2 cells, or they do not begin with 0");
  EXPECT_EQ(spoilt([](Grid& g) { g.offsets[1] = 0; }), "cell 0 of the grid has no node");
  EXPECT_EQ(spoilt([](Grid& g) { g.types[1] = 256; }), "cell 1 of the grid has no type of VTK's");
  EXPECT_EQ(spoilt([](Grid& g) { g.connectivity.push_back(0); }),
            "the last offset of the grid is not the number of its cells' nodes");
  EXPECT_EQ(spoilt([](Grid& g) { g.connectivity[3] = 3; }),
            "a cell of the grid has a node that is not there");
  EXPECT_EQ(spoilt([](Grid& g) { g.connectivity[3] = -1; }),
            "a cell of the grid has a node that is not there");
}

TEST(Field, ValuesOfAnotherNumberAreNamed) {
  const std::vector<FieldValues> values{FieldValues(9, 0.0), FieldValues(2, 1.0)};
  EXPECT_EQ(unsound(values, described, 3, 2), "");
  EXPECT_EQ(unsound({values.data(), 1}, described, 3, 2),
            "1 fields came where the description lists 2");
  EXPECT_EQ(unsound(values, described, 4, 2), "field velocity has 9 numbers where 12 belong");
  EXPECT_EQ(unsound(values, described, 3, 1), "field density has 2 numbers where 1 belong");
}

TEST(Field, TheFirstValueThatIsNotFiniteIsFound) {
  std::vector<FieldValues> values{FieldValues(9, 0.0), FieldValues(2, 1.0)};
  EXPECT_EQ(not_finite(values, described), "");
  values[1][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(not_finite(values, described), "field density is not finite at cell 1");
  values[0][5] = -infinity;
  EXPECT_EQ(not_finite(values, described), "field velocity is not finite at node 1");
}

}  // namespace
}  // namespace abut::contract_field_tests
