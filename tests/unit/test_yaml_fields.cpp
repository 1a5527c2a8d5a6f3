// Goal: one list of keys reads, refuses, echoes and documents. Oracles: identity (what is written
// reads back), and the exact text of the messages, because people act on them.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <fmt/format.h>

#include "base/fields_reference.hpp"
#include "base/input_errors.hpp"
#include "base/synonyms.hpp"
#include "base/yaml_fields.hpp"
#include "base/yaml_resolved.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_yaml_fields {
namespace {

struct Steel {
  static constexpr std::string_view name = "steel";
  double density = 0.0;
  void fields(Fields& f) {
    f.required("density", density, "kg/m^3", "reference density", positive);
  }
};
struct Void {
  static constexpr std::string_view name = "void";
  void fields(Fields&) {}
};
struct Part {
  std::string name;
  int count = 0;
  void fields(Fields& f) { f.required("count", count, "", "number of elements", at_least(1)); }
};
struct Span {
  double begin = 0.0, end = 1.0;
  void fields(Fields& f) {
    f.required("begin", begin, "s", "first time");
    f.optional("end", end, "s", "last time");
    f.check(end > begin, "end", "is before begin", "Swap the two.");
  }
};
enum class Colour { red, green };
struct All {
  double length = 0.0;
  int whole = 7;
  std::int64_t wide = 0;
  bool flag = false;
  std::string text = "x";
  std::optional<double> maybe;
  std::vector<double> numbers;
  std::vector<std::string> words;
  std::array<std::string, 2> pair{"a", "b"};
  Colour colour = Colour::red;
  std::string mode = "slow";
  Span span;
  std::optional<Span> extra;
  std::vector<Part> list;
  std::vector<std::pair<std::string, Part>> parts;
  std::variant<Steel, Void> material;
  std::optional<std::variant<Void, Steel>> coating;
  void fields(Fields& f) {
    f.required("length", length, "m", "length of the bar", positive);
    f.optional("whole", whole, "", "whole number");
    f.optional("wide", wide, "", "wide number");
    f.optional("flag", flag, "", "switch");
    f.optional("text", text, "", "title");
    f.optional("maybe", maybe, "N", "force");
    f.optional("numbers", numbers, "m", "position");
    f.optional("words", words, "", "names");
    f.optional("pair", pair, "", "two ends");
    f.word("colour", colour, {"red", "green"}, "colour");
    f.word("mode", mode, {"slow", "fast"}, "mode");
    f.defaulted("span", span, "time span");
    f.optional_section("extra", extra, "second span");
    f.list("list", list, "list of parts");
    f.map("parts", parts, "named parts", Presence::optional);
    f.choice("material", material, "material");
    f.choice("coating", coating, "coating");
  }
};

constexpr const char* minimal = "length: 2\nmaterial: void\n";

All parsed(const std::string& text, std::vector<std::string> overrides = {}) {
  return read<All>(Document::from_text("s.yaml", text, std::move(overrides)));
}

std::string refusal(const std::string& text, std::vector<std::string> overrides = {}) {
  return abut::refusal([&] { parsed(text, overrides); });
}

TEST(YamlFields, AbsentKeysKeepTheirDefaults) {
  const All all = parsed(minimal);
  EXPECT_EQ(all.whole, 7);
  EXPECT_EQ(all.text, "x");
  EXPECT_EQ(all.span.end, 1.0);
  EXPECT_FALSE(all.maybe || all.extra || all.coating);
  EXPECT_TRUE(std::holds_alternative<Void>(all.material));
}

constexpr const char* full = R"(
length: 0.25
whole: -3
wide: 9007199254740993
flag: true
text: "1.5: \"quoted\" # not a comment"
maybe: -1e-300
numbers: [0.1, -2, 3.0e+8]
words: [left, "true", "7"]
pair: [left.tip, right.tip]
colour: green
mode: fast
span: {begin: -1, end: 0.30000000000000004}
extra: {begin: 0}
list: [{count: 1}, {count: 2}]
parts: {zeta: {count: 3}, alpha: {count: 4}}
material: {steel: {density: 7850}}
coating: {void: {}}
)";

TEST(YamlFields, EveryTypeIsRead) {
  const All all = parsed(full);
  EXPECT_EQ(all.length, 0.25);
  EXPECT_EQ(all.whole, -3);
  EXPECT_EQ(all.wide, 9007199254740993);  // 2^53 + 1: no double lies between
  EXPECT_TRUE(all.flag);
  EXPECT_EQ(all.text, "1.5: \"quoted\" # not a comment");
  EXPECT_EQ(all.maybe, -1e-300);
  EXPECT_EQ(all.numbers, (std::vector<double>{0.1, -2.0, 3.0e8}));
  EXPECT_EQ(all.words, (std::vector<std::string>{"left", "true", "7"}));
  EXPECT_EQ(all.pair[1], "right.tip");
  EXPECT_EQ(all.colour, Colour::green);
  EXPECT_EQ(all.mode, "fast");
  EXPECT_EQ(all.span.end, 0.1 + 0.2);
  EXPECT_EQ(all.extra->end, 1.0);
  EXPECT_EQ(all.list.at(1).count, 2);
  EXPECT_EQ(all.parts.at(0).first, "zeta") << "the file's order is kept";
  EXPECT_EQ(all.parts.at(1).second.name, "alpha");
  EXPECT_EQ(std::get<Steel>(all.material).density, 7850.0);
  EXPECT_TRUE(std::holds_alternative<Void>(all.coating.value()));
}

TEST(ResolvedYaml, ReadsBackToTheSameValues) {
  All all = parsed(full);
  all.maybe = std::numeric_limits<double>::denorm_min();
  all.text = "tab\t and \\ and \x01";
  const std::string once = to_yaml(all);
  const All again = parsed(once);
  EXPECT_EQ(to_yaml(again), once);
  EXPECT_EQ(again.maybe, all.maybe);
  EXPECT_EQ(again.text, all.text);
  EXPECT_EQ(again.numbers, all.numbers);
  EXPECT_EQ(again.words, all.words);
  EXPECT_EQ(again.span.end, all.span.end);
  EXPECT_EQ(again.parts.at(0).first, "zeta");
}

TEST(ResolvedYaml, WritesDefaultsUnitsAndTheShortestNumber) {
  const std::string text = to_yaml(parsed("length: 0.1\nmaterial: void\n"));
  EXPECT_NE(text.find("length: 0.1  # [m]\n"), std::string::npos) << text;
  EXPECT_NE(text.find("whole: 7\n"), std::string::npos) << text;
  EXPECT_NE(text.find("material:\n  void: {}\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("coating"), std::string::npos) << "absent features stay absent";
}

TEST(ResolvedYaml, MergesReadersThatShareAMap) {
  ResolvedYaml resolved;
  resolved.add("bodies.left", Steel{.density = 2.0});
  resolved.add("bodies.left", Part{.name = "", .count = 3});
  EXPECT_EQ(resolved.text(), "bodies:\n  left:\n    density: 2.0  # [kg/m^3]\n    count: 3\n");
}

TEST(Reference, ListsEveryKeyWithTypeUnitDefaultAndMeaning) {
  Reference reference;
  reference.add<All>("", "");
  const std::string text = reference.markdown();
  for (const char* row :
       {"| `length` | number, greater than 0 | m | required | length of the bar |",
        "| `whole` | whole number |  | 7 | whole number |",
        "| `colour` | one of red, green |  | red | colour |",
        "| `span.end` | number | s | 1 | last time |",
        "| `list[i].count` | whole number, at least 1 |  | required | number of elements |",
        "| `parts.<name>.count` | whole number, at least 1 |  | required | number of elements |",
        "| `material` | choice of steel, void |  | required | material |",
        "| `coating` | choice of void, steel |  | absent | coating |",
        "| `material.steel.density` | number, greater than 0 | kg/m^3 | required | reference "
        "density |"})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\n" << text;
}

struct Bad {
  const char* name;
  const char* text;
  const char* message;
};

class BadInput : public testing::TestWithParam<Bad> {};

TEST_P(BadInput, IsRefusedWithItsMessage) {
  EXPECT_EQ(refusal(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    YamlFields, BadInput,
    testing::Values(
        Bad{"UnknownKey", "lenth: 2\nmaterial: void\n",
            "s.yaml:1: lenth: is not a known key. Did you mean length? Allowed here: length, "
            "whole, "
            "wide, flag, text, maybe, numbers, words, pair, colour, mode, span, extra, list, "
            "parts, "
            "material, coating."},
        Bad{"UnknownKeyFarFromAll",
            "length: 2\nmaterial: void\nspan:\n  begin: 0\n  xyzzyplugh: 1\n",
            "s.yaml:5: span.xyzzyplugh: is not a known key. Allowed here: begin, end."},
        Bad{"MissingKey", "length: 2\nmaterial:\n  steel: {}\n",
            "s.yaml:3: material.steel.density: is missing. Give the reference density in kg/m^3, "
            "greater than 0."},
        Bad{"MissingBareChoice", "length: 2\nmaterial: steel\n",
            "s.yaml:2: material.steel.density: is missing. Give the reference density in kg/m^3, "
            "greater than 0."},
        Bad{"OutOfRange", "length: 2\nmaterial:\n  steel:\n    density: -1000\n",
            "s.yaml:4: material.steel.density: must be positive, but is -1000 kg/m^3. Give the "
            "reference density in kg/m^3, greater than 0."},
        Bad{"NotANumber", "length: long\nmaterial: void\n",
            "s.yaml:1: length: must be a number, but is long. Give the length of the bar in m, "
            "greater than 0."},
        Bad{"QuotedNumber", "length: \"2\"\nmaterial: void\n",
            "s.yaml:1: length: must be a number, but is \"2\". Give the length of the bar in m, "
            "greater than 0."},
        Bad{"NumberWithUnitOfAnotherKind", "length: 2 s\nmaterial: void\n",
            "s.yaml:1: length: is 2 s, a time, but must be a length. Give the length of the bar in "
            "m, greater than 0."},
        Bad{"NumberWithUnknownUnit", "length: 2 parsec\nmaterial: void\n",
            "s.yaml:1: length: is 2 parsec, but parsec is not a known unit. Give the length of the "
            "bar in m, greater than 0."},
        Bad{"Nan", "length: .nan\nmaterial: void\n",
            "s.yaml:1: length: must be finite, but is .nan. Give the length of the bar in m, "
            "greater "
            "than 0."},
        Bad{"Infinity", "length: -.Inf\nmaterial: void\n",
            "s.yaml:1: length: must be finite, but is -.Inf. Give the length of the bar in m, "
            "greater than 0."},
        Bad{"FractionForWhole", "length: 2\nmaterial: void\nwhole: 1.5\n",
            "s.yaml:3: whole: must be a whole number, but is 1.5. Give the whole number as a whole "
            "number."},
        Bad{"TooLargeForInt", "length: 2\nmaterial: void\nwhole: 3000000000\n",
            "s.yaml:3: whole: must be at most 2147483647 in size, but is 3000000000. Give the "
            "whole "
            "number as a whole number."},
        Bad{"WordForFlag", "length: 2\nmaterial: void\nflag: yes\n",
            "s.yaml:3: flag: must be true or false, but is yes. Give the switch as true or false."},
        Bad{"ListForText", "length: 2\nmaterial: void\ntext: [a]\n",
            "s.yaml:3: text: must be text, but is a list. Give the title as text."},
        Bad{"NumberInList", "length: 2\nmaterial: void\nnumbers:\n  - 1\n  - x\n",
            "s.yaml:5: numbers[1]: must be a number, but is x. Give the position in m."},
        Bad{"ThreeEnds", "length: 2\nmaterial: void\npair: [a, b, c]\n",
            "s.yaml:3: pair: must be a list of two words, but has 3. Give the two ends as a list "
            "of "
            "two words."},
        Bad{"UnknownWord", "length: 2\nmaterial: void\nmode: fats\n",
            "s.yaml:3: mode: is fats, which is not a known choice. Did you mean fast? Choose one "
            "of "
            "slow, fast."},
        Bad{"UnknownChoice", "length: 2\nmaterial: {stel: {density: 1}}\n",
            "s.yaml:2: material.stel: is not a known choice. Did you mean steel? Choose one of "
            "steel, void."},
        Bad{"TwoChoices", "length: 2\nmaterial: {steel: {density: 1}, void: {}}\n",
            "s.yaml:2: material.void: stands beside steel, but only one can be chosen. Give the "
            "material as {name: {its keys}}, with one of steel, void."},
        Bad{"EmptySection", "length: 2\nmaterial: void\nspan:\n",
            "s.yaml:3: span: must be a map of keys, but is empty. Give the time span as a map of "
            "keys; {} stands for its defaults."},
        Bad{"CrossKeyRule", "length: 2\nmaterial: void\nspan:\n  begin: 3\n  end: 2\n",
            "s.yaml:5: span.end: is before begin. Swap the two."},
        Bad{"ItemOfAList", "length: 2\nmaterial: void\nlist:\n  - count: 1\n  - count: 0\n",
            "s.yaml:5: list[1].count: must be at least 1, but is 0. Give the number of elements as "
            "a "
            "whole number, at least 1."},
        Bad{"NameWithADot", "length: 2\nmaterial: void\nparts: {a.b: {count: 1}}\n",
            "s.yaml:3: parts.a.b: is not a name. Use letters, digits, _ and - alone."},
        Bad{"DuplicateKey", "length: 2\nmaterial: void\nspan: {begin: 0}\nlength: 3\n",
            "s.yaml:4: length: is given twice. Remove one of the two."},
        Bad{"TwoDocuments", "length: 2\n---\nlength: 3\n",
            "s.yaml:2: holds a second document. Write one scene per file, without --- lines "
            "between its parts."},
        Bad{"NotAMap", "- a\n- b\n",
            "s.yaml: is not a map of keys. Write a scene as key: value lines, beginning with "
            "time:, bodies:."},
        Bad{"Empty", "",
            "s.yaml: is empty. Write a scene as key: value lines, beginning with "
            "time:, bodies:."}),
    [](const testing::TestParamInfo<Bad>& instance) { return std::string(instance.param.name); });

TEST(YamlFields, AllErrorsAreTold) {
  try {
    parsed(
        "length: -1\nwhole: 0.5\nmaterial: {stel: {}}\nspan: {begin: 2}\nlist: [{}, {count: 0}]\n"
        "colour: blue\n");
    ADD_FAILURE() << "accepted";
  } catch (const InputErrorList& errors) {
    std::string all;
    for (const InputError& error : errors.all)
      all += error.where + ": " + error.what_is_wrong + "\n";
    EXPECT_EQ(all,
              "s.yaml:1: length: must be positive, but is -1 m\n"
              "s.yaml:2: whole: must be a whole number, but is 0.5\n"
              "s.yaml:6: colour: is blue, which is not a known choice\n"
              "s.yaml:4: span.end: is before begin\n"
              "s.yaml:5: list[0].count: is missing\n"
              "s.yaml:5: list[1].count: must be at least 1, but is 0\n"
              "s.yaml:3: material.stel: is not a known choice\n");
  }
}

TEST(YamlFields, AMisspeltKeyIsNotMissingAsWell) {
  EXPECT_EQ(refusal("lenght: 2\nmaterial: void\n").substr(0, 66),
            "s.yaml:1: lenght: is not a known key. Did you mean length? Allowed");
}

// Goal: other programs' words lead to ours. Oracle: the list of what people write.
TEST(Synonyms, LeadToOurWords) {
  const std::vector<std::string> known = {"youngs_modulus",     "density", "linear_elastic", "step",
                                          "central_difference", "newmark", "traction",       "end"};
  const std::pair<const char*, const char*> words[] = {{"E", "youngs_modulus"},
                                                       {"young", "youngs_modulus"},
                                                       {"rho", "density"},
                                                       {"elastic", "linear_elastic"},
                                                       {"dt", "step"},
                                                       {"time-step", "step"},
                                                       {"explicit", "central_difference"},
                                                       {"implicit", "newmark"},
                                                       {"Force", "traction"},
                                                       {"t_end", "end"}};
  for (const auto& [word, ours] : words) EXPECT_EQ(meant_by(word, known), ours) << word;
  EXPECT_EQ(meant_by("E", {{"density"}}), "") << "only what is allowed there";
  EXPECT_EQ(meant_by("wheel", known), "");
}

TEST(YamlFields, TagsAreRefused) {
  for (const std::string tag : {"!km_per_h", "!!int", "!!str", "!<tag:x>"}) {
    EXPECT_NE(refusal("length: " + tag + " 2\nmaterial: void\n").find("has the tag"),
              std::string::npos)
        << tag;
    EXPECT_NE(refusal("length: 2\nmaterial: void\nnumbers: " + tag + " [1]\n").find("has the tag"),
              std::string::npos)
        << tag;
  }
  EXPECT_EQ(refusal("length: 2\nmaterial: void\ntext: \"quoted\"\n"), "not refused");
  EXPECT_EQ(refusal("length: 2\nmaterial: \"void\"\n"), "not refused");
}

TEST(YamlFields, SyntaxErrorNamesItsLine) {
  const std::string message = refusal("length: 2\nmaterial: {steel: [}\n");
  EXPECT_TRUE(message.starts_with("s.yaml:2: is not readable as YAML: ")) << message;
}

TEST(YamlFields, AnAnchorThatGrowsWithoutBoundIsRefused) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    bomb += fmt::format("a{0}: &a{0} [", i);
    for (int k = 0; k < 10; ++k) bomb += fmt::format("{}*a{}", k > 0 ? ", " : "", i - 1);
    bomb += "]\n";
  }
  EXPECT_EQ(refusal(bomb), "s.yaml: holds too many values. Remove anchors that repeat themselves.");
}

TEST(Overrides, ReplaceAddAndReachIntoLists) {
  const All all = parsed(full, {"length=0.5", "material={steel: {density: 1}}", "list[1].count=9",
                                "parts.alpha.count=5", "extra.end=4"});
  EXPECT_EQ(all.length, 0.5);
  EXPECT_EQ(std::get<Steel>(all.material).density, 1.0);
  EXPECT_EQ(all.list[1].count, 9);
  EXPECT_EQ(all.parts[1].second.count, 5);
  EXPECT_EQ(all.extra->end, 4.0);
}

TEST(Overrides, NullTakesTheKeyOut) {
  EXPECT_FALSE(parsed(full, {"extra=null"}).extra.has_value());
  EXPECT_NE(refusal(minimal, {"length=null"}).find("length"), std::string::npos);  // required
}

TEST(Overrides, CreateMapsOnTheWay) {
  EXPECT_EQ(parsed(minimal, {"span.begin=-5"}).span.begin, -5.0);
}

TEST(Overrides, ChangeOneOfTwoMapsThatShareAnAnchor) {
  const All all =
      parsed("length: 2\nmaterial: void\nparts: {a: &p {count: 1}, b: *p}\n", {"parts.b.count=2"});
  EXPECT_EQ(all.parts[0].second.count, 1);
  EXPECT_EQ(all.parts[1].second.count, 2);
}

TEST(Overrides, MessagesSayWhereTheValueCameFrom) {
  EXPECT_EQ(refusal(minimal, {"length=-1"}),
            "s.yaml, from --set length=-1: length: must be positive, but is -1 m. Give the length "
            "of the bar in m, greater than 0.");
  EXPECT_EQ(refusal(minimal, {"spam.begin=1"}).substr(0, 70),
            "s.yaml, from --set spam.begin=1: spam: is not a known key. Did you mea");
}

TEST(Overrides, WithoutAPlaceOrFormAreRefused) {
  EXPECT_EQ(refusal(minimal, {"length"}),
            "--set length: is not of the form key.path=value. Write for example --set "
            "time.window=1e-6.");
  EXPECT_EQ(
      refusal(minimal, {"length.x=1"}),
      "--set length.x=1: has no place in the scene. Name a key of a map; all but the last key "
      "must lead to maps.");
  EXPECT_EQ(refusal(full, {"list[2].count=1"}),
            "--set list[2].count=1: has no place in the scene. Name an item that the list has, "
            "counted from 0.");
}

TEST(Document, KeepsTextNameAndOverridesForAnotherProcess) {
  const Document here = Document::from_text("s.yaml", full, {"whole=1"});
  const Document there = Document::from_text(here.name(), here.text(), here.overrides());
  EXPECT_EQ(to_yaml(read<All>(there)), to_yaml(read<All>(here)));
  EXPECT_EQ(there.where("parts.alpha.count"), here.where("parts.alpha.count"));
}

TEST(Document, LocatesAPathThatIsNotThereAtItsNearestAncestor) {
  const Document document = Document::from_text("s.yaml", "a:\n  b: {c: 1}\n");
  EXPECT_EQ(document.where("a.b.d"), "s.yaml:2: a.b.d");
  EXPECT_EQ(document.where("z"), "s.yaml: z");
  EXPECT_EQ(document.where(""), "s.yaml");
}

TEST(Document, AFileThatIsNotThereIsTheUsersError) {
  EXPECT_THROW(Document::load("no/such/file.yaml"), InputError);
}

TEST(ReadAt, ReadsTheSubtreeAndReportsTheWholePath) {
  const Document document = Document::from_text("s.yaml", "bodies:\n  left: {density: 0}\n");
  try {
    read<Steel>(document, "bodies.left");
    FAIL() << "a density of zero is refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where, "s.yaml:2: bodies.left.density");
  }
  EXPECT_THROW(read<Steel>(document, "bodies.right"), InputError);
}

struct FirstReader {
  double density = 0.0;
  void fields(Fields& f) {
    f.required("density", density, "kg/m^3", "density");
    f.ignore_rest();
  }
};
struct SecondReader {
  double length = 0.0;
  void fields(Fields& f) {
    f.ignore("density");
    f.required("length", length, "m", "length");
  }
};

TEST(ReadAt, TwoReadersShareAMap) {
  const Document document = Document::from_text("s.yaml", "density: 1\nlength: 2\n");
  EXPECT_EQ(read<FirstReader>(document).density, 1.0);
  EXPECT_EQ(read<SecondReader>(document).length, 2.0);
  const Document wrong = Document::from_text("s.yaml", "density: 1\nlength: 2\nlenght: 3\n");
  EXPECT_EQ(read<FirstReader>(wrong).density, 1.0);
  EXPECT_THROW(read<SecondReader>(wrong), InputError);
}

TEST(Nearest, FindsAMisspellingAndNothingFarAway) {
  const std::vector<std::string> words{"youngs_modulus", "density"};
  EXPECT_EQ(nearest("young_modulus", words), "youngs_modulus");
  EXPECT_EQ(nearest("poisson", words), "");
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

}  // namespace
}  // namespace abut::test_yaml_fields
