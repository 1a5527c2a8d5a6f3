// Goal: many equal bodies are written once. Oracles: the bodies written out by hand; the place in
// the text where a key stands; the exact text of refusals.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/error.hpp"
#include "base/yaml_document.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_yaml_copies {
namespace {

using Overrides = std::vector<std::string>;

/// A scene whose body `ball` in two dimensions has these copies, on the line 3, and keys.
std::string scene(const std::string& copies, const std::string& keys = "",
                  const std::string& others = "") {
  return "bodies:\n  ball:\n    copies: " + copies + "\n    model: {fe: {dimension: 2}}\n" + keys +
         others;
}

Document document(const std::string& text, Overrides overrides = {}) {
  return Document::from_text("s.yaml", text, std::move(overrides));
}

/// A value in one line, its keys in their order.
std::string value(const Document& text, const std::string& body, const std::string& key) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << YAML::Clone(text.root()["bodies"][body][key]);
  std::string line;
  for (const char letter : std::string(out.c_str()))
    if (letter != '\n') line += letter;
  return line;
}

std::string refusal(const std::string& text, Overrides overrides = {}) {
  return abut::refusal([&] { document(text, overrides); });
}

constexpr const char* grid = "{grid: {count: [2, 3], spacing: [0.5, -0.25]}}";

TEST(Copies, OfAGridStandInRowsWithTheFirstAxisFastest) {
  const Document text = document(scene(grid, "    initial: {position: [1, 2], velocity: [3, 4]}\n",
                                       "  wall: {model: rigid_wall}\n"));
  EXPECT_EQ(text.keys("bodies"), (std::vector<std::string>{"ball_1", "ball_2", "ball_3", "ball_4",
                                                           "ball_5", "ball_6", "wall"}));
  const std::vector<std::string> places = {"[1, 2]",      "[1.5, 2]", "[1, 1.75]",
                                           "[1.5, 1.75]", "[1, 1.5]", "[1.5, 1.5]"};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string name = "ball_" + std::to_string(i + 1);
    EXPECT_EQ(value(text, name, "initial"), "{position: " + places[i] + ", velocity: [3, 4]}");
    EXPECT_EQ(value(text, name, "model"), "{fe: {dimension: 2}}");
    EXPECT_FALSE(text.has("bodies." + name + ".copies"));
  }
  EXPECT_EQ(text.body_of_copy("ball_3"), "ball");
  EXPECT_EQ(text.body_of_copy("wall"), "");
  EXPECT_EQ(text.copies_of("ball"), "ball_1 to ball_6");
}

/// Tables and listings sort by name.
TEST(Copies, AreNumberedWithAsManyDigitsAsTheLast) {
  const Document ten = document(scene("{grid: {count: [10, 1], spacing: [1, 0]}}"));
  EXPECT_EQ(ten.copies_of("ball"), "ball_01 to ball_10");
  EXPECT_EQ(document(scene("{list: [{}]}")).copies_of("ball"), "ball_1");
}

TEST(Copies, OfAListAddPlaceAndSpeedAndReplaceTheRest) {
  const Document text = document(
      scene("{list: [{position: [0.25, 0]}, {velocity: [0, -1]}, {adjust: false, position: [0, 1], "
            "velocity_field: null}]}",
            "    initial: {position: [1, 2], adjust: true, velocity_field: [y, '0']}\n"));
  EXPECT_EQ(value(text, "ball_1", "initial"),
            "{position: [1.25, 2], adjust: true, velocity_field: [y, 0]}");
  EXPECT_EQ(value(text, "ball_2", "initial"),
            "{position: [1, 2], adjust: true, velocity_field: [y, 0], velocity: [0, -1]}");
  EXPECT_EQ(value(text, "ball_3", "initial"), "{position: [1, 3], adjust: false}");
}

/// [0.0] is what a body without a place has.
TEST(Copies, OfBodiesWithoutAPlaceHaveTheirOwn) {
  EXPECT_EQ(value(document(scene("{list: [{position: [0.1, 2]}]}")), "ball_1", "initial"),
            "{position: [0.1, 2]}");
  EXPECT_EQ(
      value(document(scene("{list: [{position: [0.1, 2]}]}", "    initial: {position: [0]}\n")),
            "ball_1", "initial"),
      "{position: [0.1, 2]}");
  const Document wall =
      document("bodies: {w: {copies: {grid: {count: [2], spacing: [3]}}, model: rigid_wall}}");
  EXPECT_EQ(value(wall, "w_2", "initial"), "{position: [3]}");
}

/// A body that spins about its centre has copies that spin about theirs; points are nodes of it.
TEST(Copies, TakePointsAndInitialFieldsAlong) {
  const Document text = document(scene(
      "{list: [{position: [0.5, -2]}, {velocity_field: ['-x', max(y, 1e-3)], position: [1, 0]}]}",
      "    initial: {velocity_field: [-3 * y, 3*x]}\n"
      "    points: {tip: {at: [0.5, 0]}}\n    loads: {push: {pressure: x}}\n"));
  EXPECT_EQ(value(text, "ball_1", "initial"),
            "{velocity_field: [-3 * (y + 2), 3*(x - 0.5)], position: [0.5, -2]}");
  EXPECT_EQ(value(text, "ball_2", "initial"),
            "{velocity_field: [-(x - 1), max(y, 1e-3)], position: [1, 0]}");
  EXPECT_EQ(value(text, "ball_1", "points"), "{tip: {at: [1, -2]}}");
  EXPECT_EQ(value(text, "ball_1", "loads"), "{push: {pressure: x}}");  // of places in space
}

TEST(Copies, AreLikeWhatTheirBodyIsLikeAndAreNotInherited) {
  const Document text = document(
      scene(grid, "    material: {steel: {density: 3}}\n",
            "  big: {like: ball, material: {steel: {density: 4}}}\n"
            "  more: {like: big, copies: {list: [{position: [1, 1]}, {position: [2, 2]}]}}\n"));
  EXPECT_EQ(value(text, "big", "material"), "{steel: {density: 4}}");
  EXPECT_FALSE(text.has("bodies.big.copies"));
  EXPECT_EQ(value(text, "more_2", "material"), "{steel: {density: 4}}");
  EXPECT_EQ(value(text, "more_2", "model"), "{fe: {dimension: 2}}");
  EXPECT_EQ(text.where("bodies.more_2.model.fe.dimension"),
            "s.yaml:4: bodies.more.model.fe.dimension (like ball)");
}

TEST(Copies, FollowOverridesOfTheirBodyAndHaveTheirOwn) {
  const std::string text = scene(grid, "    initial: {velocity: [3, 4]}\n");
  const Document fewer =
      document(text, {"bodies.ball.copies.grid.count=[1, 2]", "bodies.ball.initial.velocity=[5, 6]",
                      "bodies.ball_2.initial.velocity=[7, 8]"});
  EXPECT_EQ(fewer.keys("bodies"), (std::vector<std::string>{"ball_1", "ball_2"}));
  EXPECT_EQ(value(fewer, "ball_1", "initial"), "{velocity: [5, 6], position: [0, 0]}");
  EXPECT_EQ(value(fewer, "ball_2", "initial"), "{velocity: [7, 8], position: [0, -0.25]}");
  EXPECT_EQ(fewer.where("bodies.ball_2.initial.velocity"),
            "s.yaml, from --set bodies.ball_2.initial.velocity=[7, 8]: "
            "bodies.ball_2.initial.velocity");
  EXPECT_FALSE(document(text, {"bodies.ball_3=null"}).has("bodies.ball_3"));
  EXPECT_EQ(document(text, {"bodies.ball.copies=null"}).keys("bodies"), Overrides{"ball"});
  EXPECT_EQ(
      refusal(text, {"bodies.ball_7.initial.velocity=[7, 8]"}),
      "--set bodies.ball_7.initial.velocity=[7, 8]: is of no copy: ball has the copies ball_1 "
      "to ball_6. Name one of them.");
  for (const std::string set : {"bodies.ball_2.like=ball", "bodies.ball_2={like: ball}"})
    EXPECT_EQ(refusal(text, {set}), "--set " + set +
                                        ": has no effect: ball_2 is a copy. Leave like out, or "
                                        "give it to the body.");
  EXPECT_EQ(refusal(text, {"bodies.ball_2.copies={list: [{}]}"}),
            "--set bodies.ball_2.copies={list: [{}]}: has no effect: ball_2 is a copy. Leave "
            "copies out, or give it to the body.");
}

TEST(Copies, KeysAreLocatedWhereTheyAreWrittenOnce) {
  const Document text = document(scene(grid, "    initial:\n      velocity: [3, 4]\n"));
  for (const std::string name : {"bodies.ball_1", "bodies.ball_6"}) {
    EXPECT_EQ(text.where(name + ".model.fe"), "s.yaml:4: bodies.ball.model.fe");
    EXPECT_EQ(text.where(name + ".initial.velocity[1]"),
              "s.yaml:6: bodies.ball.initial.velocity[1]");
    EXPECT_EQ(text.where(name + ".initial.position"), "s.yaml:3: bodies.ball.copies.grid");
    EXPECT_EQ(text.where(name), "s.yaml:2: bodies.ball");
  }
  const Document listed =
      document(scene("\n      list:\n      - {position: [1, 2]}\n"
                     "      - position: [1, 2]\n        adjust: true\n"));
  EXPECT_EQ(listed.where("bodies.ball_2.initial.adjust"),
            "s.yaml:7: bodies.ball.copies.list[1].adjust");
  EXPECT_EQ(listed.where("bodies.ball_1.initial.adjust"), "s.yaml:2: bodies.ball.initial.adjust");
}

class CopiesOfATable : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Document read(const std::string& table, const std::string& keys = "") {
    std::ofstream(folder_ / "t.csv") << table;
    return Document::from_text((folder_ / "s.yaml").string(),
                               scene("{table: {file: t.csv}}", keys));
  }
  /// Behind the names of both files.
  std::string refused(const std::string& table) {
    try {
      read(table);
    } catch (const InputError& error) {
      const std::string text = error.what(), file = (folder_ / "t.csv").string();
      return text.substr(text.find(file) + file.size());
    }
    return "accepted";
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("abut_copies_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CopiesOfATable, HaveItsRows) {
  const std::string own = "    initial: {position: [1, 1]}\n";
  const Document all = read("# two balls\nx, vy ,vx\r\n 0.1,2,  -3e-1 # first\n\n+4,5,6", own);
  EXPECT_EQ(value(all, "ball_1", "initial"), "{position: [1.1, 1], velocity: [-0.3, 2]}");
  EXPECT_EQ(value(all, "ball_2", "initial"), "{position: [5, 1], velocity: [6, 5]}");
  EXPECT_EQ(all.keys("bodies").size(), 2u);
  EXPECT_EQ(value(read("vx\n2\n", own), "ball_1", "initial"),
            "{position: [1, 1], velocity: [2, 0]}");
}

/// Another process, perhaps on another machine, reads no table.
TEST_F(CopiesOfATable, AreTheSameWhereThereIsNoTable) {
  const Document here = read("x,vy\n0.1,0.30000000000000004\n1e-300,-5e22\n");
  const Document there =
      Document::from_text("elsewhere/s.yaml", here.text(), here.overrides_elsewhere());
  ASSERT_EQ(there.keys("bodies"), here.keys("bodies"));
  for (const std::string& name : here.keys("bodies"))
    EXPECT_EQ(value(there, name, "initial"), value(here, name, "initial"));
  EXPECT_EQ(value(there, "ball_2", "initial"), "{position: [1e-300, 0], velocity: [0, -5e+22]}");
  const Document set = Document::from_text(
      here.name(), here.text(), {"bodies.ball_1.initial.velocity=[1, 2]"});  // of a copy, as well
  const Document set_there =
      Document::from_text("elsewhere/s.yaml", set.text(), set.overrides_elsewhere());
  EXPECT_EQ(value(set_there, "ball_1", "initial"), "{position: [0.1, 0], velocity: [1, 2]}");
}

TEST_F(CopiesOfATable, AreRefusedByLineAndColumn) {
  const std::string columns =
      "Begin the table with a line of its columns, some of x, y, z in m and vx, vy, vz in m/s.";
  EXPECT_EQ(refused("# nothing\n"), ": is empty. " + columns);
  EXPECT_EQ(refused("0.1, 0.2\n"), ":1: has the column 0.1, which is not known. " + columns);
  EXPECT_EQ(refused("x,,y\n"), ":1: has a column without a name. " + columns);
  EXPECT_EQ(refused("x,y,x\n"), ":1: has the column x twice. Take one of the two out.");
  EXPECT_EQ(refused("x,vz\n1,2\n"),
            ":1: has the column vz, but the body has two dimensions. Take the column out.");
  for (const std::string cell : {"nan", "inf", "1e999", "1 2", "0x10"})
    EXPECT_EQ(refused("x\n1\n" + cell + "\n"),
              ":3: has " + cell +
                  " in the column x, which is not a finite number. "
                  "Give a number.");
  EXPECT_EQ(refused("x,y\n1,\n"),
            ":2: has nothing in the column y, which is not a finite number. Give a number.");
  std::string rows = "x\n";
  for (int i = 0; i < 10'001; ++i) rows += "1\n";
  EXPECT_EQ(refused(rows), ":10002: has more than 10000 rows. Give fewer copies.");
}

TEST(Copies, RefusesMoreThanAnySceneHolds) {
  std::string numbers;
  for (int i = 0; i < 100; ++i) numbers += "1,";
  const std::string text =
      scene("{grid: {count: [100, 20], spacing: [1, 1]}}", "    x: [" + numbers + "1]\n");
  EXPECT_EQ(refusal(text),
            "s.yaml:3: bodies.ball.copies: makes too many values, written out. Give fewer copies.");
  std::string places;  // a list is read once, whatever its length
  for (int i = 0; i < 2000; ++i) places += "{position: [1, 2], velocity: [3, 4]},";
  EXPECT_EQ(refusal(scene("{list: [" + places + "]}")), "not refused");
}

}  // namespace
}  // namespace abut::test_yaml_copies
