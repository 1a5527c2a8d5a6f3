#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace abut {

/// Powers of length, mass and time.
struct Dimension {
  int length = 0, mass = 0, time = 0;
  bool operator==(const Dimension&) const = default;
};

/// `mantissa` times ten to the power of `exponent` SI units. Powers of ten are kept apart, so that
/// 250 mm is the same number as 0.25 m.
struct Unit {
  Dimension dimension;
  double mantissa = 1.0;
  int exponent = 0;
};

/// "kg/m^3", "N/mm2", "GPa", "um": SI units with their prefixes, t, g, bar, min, deg, and in, ft,
/// lb, lbf, psi, ksi, with powers, * and /. Nothing where a word is no unit.
std::optional<Unit> parse_unit(std::string_view text);

/// A number with a unit: "5 mm", "210GPa".
struct Quantity {
  std::string_view number, unit;
};

/// Nothing where a text is not a number with a word behind it; whether that is a unit is not asked.
std::optional<Quantity> split_quantity(std::string_view text);

/// A number's text in another unit of the same dimension. Nothing: it is not finite.
std::optional<double> converted(std::string_view number, const Unit& from, const Unit& to);

/// "a length", "a pressure", "a density"; others as their powers: "kg m/s^3".
std::string dimension_words(const Dimension& dimension);

/// The units of a scene's numbers: a length, a mass and a time, from which all others follow.
class UnitSystem {
 public:
  UnitSystem() = default;  // SI
  /// "SI", or three units as "mm t s", in any order. Nothing where it is neither.
  static std::optional<UnitSystem> parse(std::string_view text);

  bool is_si() const { return words_.empty(); }
  /// What a scene calls it: "SI", "mm t s".
  std::string words() const { return is_si() ? "SI" : words_; }
  /// The system's unit where SI has this one: "Pa" is "MPa" in "mm t s". A text that is no unit of
  /// length, mass and time stays.
  std::string word(std::string_view si_unit) const;

 private:
  Unit of(const Dimension& dimension) const;
  std::string words_, length_word_ = "m", mass_word_ = "kg", time_word_ = "s";
  Unit length_{{1, 0, 0}}, mass_{{0, 1, 0}}, time_{{0, 0, 1}};
};

}  // namespace abut
