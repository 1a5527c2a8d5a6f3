// Goal: the reference tells every key, all of them or a part, and what alternatives have in common
// once. Oracle: the keys of small structs, written out.
#include <gtest/gtest.h>

#include <string>

#include "base/fields_reference.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_fields_reference {
namespace {

struct Steel {
  static constexpr std::string_view name = "steel";
  double density = 0.0;
  void fields(Fields& f) {
    f.required("density", density, "kg/m^3", "reference density", positive);
  }
};
struct Wood {
  static constexpr std::string_view name = "wood";
  double density = 0.0, grain = 0.0;
  void fields(Fields& f) {
    f.required("density", density, "kg/m^3", "reference density", positive);
    f.optional("grain", grain, "", "direction of the grain");
  }
};
struct Ply {
  static constexpr std::string_view name = "ply";
  double grain = 0.0;
  void fields(Fields& f) { f.optional("grain", grain, "", "direction of the grain"); }
};
struct Part {
  std::string name;
  int count = 0;
  void fields(Fields& f) { f.required("count", count, "", "number of elements", at_least(1)); }
};
struct Stuff {
  std::variant<Steel, Wood> all;
  std::variant<Steel, Wood, Ply> some;
  std::vector<Part> list;
  std::vector<std::pair<std::string, Part>> parts;
  void fields(Fields& f) {
    f.choice("all", all, "material");
    f.choice("some", some, "material");
    f.list("list", list, "list of parts");
    f.map("parts", parts, "named parts", Presence::optional);
  }
};

Reference reference_at(std::string_view path) {
  Reference reference;
  reference.add<Stuff>("", path);
  return reference;
}

TEST(ReferenceOfChoices, WhatAlternativesHaveInCommonStandsOnce) {
  const std::string text = reference_at("part").markdown();
  for (const char* row :
       {"| `part.all.*.density` |", "| `part.all.wood.grain` |",
        "| `part.some.{steel,wood}.density` |", "| `part.some.{wood,ply}.grain` |"})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\n" << text;
  EXPECT_EQ(text.find(".ply.grain"), std::string::npos) << text;
}

TEST(ReferenceOfChoices, PathsAreToldOneByOne) {
  EXPECT_EQ(reference_at("part").key_paths(),
            "part.all\npart.all.steel.density\npart.all.wood.density\npart.all.wood.grain\n"
            "part.some\npart.some.steel.density\npart.some.wood.density\npart.some.wood.grain\n"
            "part.some.ply.grain\npart.list\npart.list[i].count\npart.parts\n"
            "part.parts.<name>.count\n");
}

TEST(PartOfTheReference, IsOfAKeyPathOfAScene) {
  const Reference reference = reference_at("bodies.<name>");
  EXPECT_EQ(reference.part("bodies.left.all.steel"),
            "bodies.<name>.all.steel.density\n    number, greater than 0 [kg/m^3]; required\n"
            "    reference density\n");
  EXPECT_EQ(reference.part("bodies.left.parts.a"),
            "bodies.<name>.parts.<name>.count\n    whole number, at least 1; required\n    number "
            "of elements\n");
  EXPECT_EQ(reference.part("bodies.left.list[3].count"),
            "bodies.<name>.list[i].count\n    whole number, at least 1; required\n    number of "
            "elements\n");
  EXPECT_TRUE(
      reference.part("bodies").starts_with("bodies.<name>.all\n    choice of steel, wood;"));
}

TEST(PartOfTheReference, AKeyThatIsNoneIsRefusedWithTheOneThatWasMeant) {
  const Reference reference = reference_at("bodies.<name>");
  EXPECT_EQ(refusal([&] { reference.part("bodies.left.som"); }),
            "bodies.left.som: is not a key of a scene. Did you mean some? There are: all, some, "
            "list, parts.");
  EXPECT_EQ(refusal([&] { reference.part("bodies.left.all.ply"); }),
            "bodies.left.all.ply: is not a key of a scene. There are: steel, wood.");
  EXPECT_EQ(refusal([&] { reference.part("bodies.left.all.steel.density.x"); }),
            "bodies.left.all.steel.density.x: is not a key of a scene. The key before it has none "
            "below.");
  EXPECT_EQ(refusal([&] { reference.part("some"); }),
            "some: is not a key of a scene. There is bodies.<name>.some.");
}

}  // namespace
}  // namespace abut::test_fields_reference
