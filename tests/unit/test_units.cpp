// Goal: units mean what they say, and a number is the same whatever unit it is written in. Oracles:
// definitions of the units; literals of the same number.
#include <gtest/gtest.h>

#include <string>

#include "base/unit_words.hpp"
#include "base/units.hpp"

namespace abut::test_units {
namespace {

/// The text in another unit, both of one dimension.
double in(std::string_view text, std::string_view unit) {
  const std::optional<Quantity> parts = split_quantity(text);
  EXPECT_TRUE(parts) << text;
  const std::optional<Unit> from = parse_unit(parts->unit), to = parse_unit(unit);
  EXPECT_TRUE(from && to && from->dimension == to->dimension) << text << " in " << unit;
  return converted(parts->number, *from, *to).value();
}

TEST(Units, ANumberIsTheOneNearestToWhatIsWritten) {
  EXPECT_EQ(in("210 GPa", "Pa"), 210.0e9);
  EXPECT_EQ(in("0.7mm", "m"), 0.7e-3);
  EXPECT_EQ(in("5.1e-3 mm", "m"), 5.1e-6);
  EXPECT_EQ(in("1.3E+2 um", "mm"), 0.13);
  EXPECT_EQ(in("7.85 g/cm^3", "kg/m^3"), 7850.0);
  EXPECT_EQ(in("7850 kg/m3", "t/mm^3"), 7850.0e-12);
  EXPECT_EQ(in("210 kN/mm^2", "GPa"), 210.0);
  EXPECT_EQ(in("-9.81 m/s^2", "mm/ms^2"), -9.81e-3);
  EXPECT_EQ(in("10 \u00b5s", "s"), 10.0e-6);
  EXPECT_EQ(in("2 min", "s"), 120.0);
}

TEST(Units, UnitsOfInchesAreTheirDefinitions) {
  EXPECT_EQ(in("1 in", "mm"), 25.4);
  EXPECT_EQ(in("1 lb", "kg"), 0.45359237);
  EXPECT_DOUBLE_EQ(in("1 psi", "Pa"), 4.4482216152605 / (0.0254 * 0.0254));
  EXPECT_DOUBLE_EQ(in("90 deg", "rad"), 1.5707963267948966);
}

TEST(Units, WordsThatAreNoUnitsAreNone) {
  for (const char* text : {"", "mmm", "kt", "x", "kg/", "/s", "m^", "m^x", "m s", "kmin", "m**s"})
    EXPECT_FALSE(parse_unit(text)) << text;
  for (const char* text : {"", "5", "mm", "5*x", "5 * t", "1e6", "1e6 + t", "nan m", "5 /s"})
    EXPECT_FALSE(split_quantity(text)) << text;
}

TEST(Units, DimensionsHaveWords) {
  EXPECT_EQ(dimension_words(parse_unit("kg/m^3")->dimension), "a density");
  EXPECT_EQ(dimension_words(parse_unit("mm")->dimension), "a length");
  EXPECT_EQ(dimension_words(parse_unit("m^4")->dimension), "m^4 kg^0 s^0");
}

TEST(UnitSystems, NameWhatFollowsFromTheirUnits) {
  const UnitSystem tonne = UnitSystem::parse("mm t s").value();
  EXPECT_EQ(tonne.word("m"), "mm");
  EXPECT_EQ(tonne.word("N"), "N");
  EXPECT_EQ(tonne.word("Pa"), "MPa");
  EXPECT_EQ(tonne.word("J"), "mJ");
  EXPECT_EQ(tonne.word("kg/m^3"), "t/mm^3");
  EXPECT_EQ(tonne.word("m/s^2"), "mm/s^2");
  EXPECT_EQ(tonne.word("N/m"), "t/s^2");
  EXPECT_EQ(tonne.word("Hz"), "1/s");
  const UnitSystem impact = UnitSystem::parse("kg, ms, mm").value();
  EXPECT_EQ(impact.words(), "mm kg ms");
  EXPECT_EQ(impact.word("N"), "kN");
  EXPECT_EQ(impact.word("Pa"), "GPa");
  for (const char* same : {"", "MiB", "s (clock)", "rad"}) EXPECT_EQ(impact.word(same), same);
  for (const char* si : {"m", "Pa", "N/m", "Hz"}) EXPECT_EQ(UnitSystem().word(si), si);
}

TEST(UnitSystems, EveryWordOfASystemIsAUnitThatReadsBack) {
  for (const char* words : {"mm t s", "mm kg ms", "cm g us", "in lb s"}) {
    const UnitSystem system = UnitSystem::parse(words).value();
    for (const char* si : {"m", "Pa", "kg/m^3", "N/m", "m/s^2", "kg/s", "Hz", "J"})
      EXPECT_EQ(parse_unit(system.word(si)).value().dimension, parse_unit(si).value().dimension)
          << system.word(si);
  }
}

TEST(UnitSystems, AreSpokenBetweenBrackets) {
  const UnitSystem system = UnitSystem::parse("mm t s").value();
  EXPECT_EQ(in_words_of(system, "p [kg m/s], l [kg m^2/s], u [m], t [s (clock)], e [%], N [m"),
            "p [t mm/s], l [t mm^2/s], u [mm], t [s (clock)], e [%], N [m");
  EXPECT_EQ(in_words_of(UnitSystem(), "p [kg m/s]"), "p [kg m/s]");
}

TEST(UnitSystems, AreSpokenBehindNumbers) {
  const auto words = unit_words(UnitSystem::parse("mm t s").value());
  EXPECT_EQ(quantities_in(words, "'m' closes at 1e-3 m/s, 2 m deep at (1, 2) m; 3 J, 4 kg m/s"),
            "'m' closes at 1e-3 mm/s, 2 mm deep at (1, 2) mm; 3 mJ, 4 t mm/s");
  for (const char* stays : {"3 more of s", "3 mm", "4 steps m", "2 MiB", "1 s^3", "(digest 1) s2"})
    EXPECT_EQ(quantities_in(words, stays), stays);
  EXPECT_EQ(quantities_in(unit_words(UnitSystem::parse("mm kg ms").value()), "5 s. 7 N, 8 N m"),
            "5 ms. 7 kN, 8 J");
  EXPECT_EQ(quantities_in(declared_units("SI"), "5 m"), "5 m");
  EXPECT_EQ(quantities_in(declared_units("mm t s"), "5 m"), "5 mm");
}

TEST(UnitSystems, AreALengthAMassAndATime) {
  EXPECT_TRUE(UnitSystem::parse("SI").value().is_si());
  EXPECT_TRUE(UnitSystem::parse("kg m s").value().is_si());
  for (const char* text : {"", "mm", "mm t", "mm t s s", "mm mm s", "mm N s", "mm t x"})
    EXPECT_FALSE(UnitSystem::parse(text)) << text;
}

}  // namespace
}  // namespace abut::test_units
