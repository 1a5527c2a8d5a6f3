#include "base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "base/unit_pattern.hpp"

namespace abut {
namespace {

struct Symbol {
  std::string_view word;
  Unit unit;
  bool prefixed = false;  // takes SI prefixes
};

constexpr Dimension none{}, length{1, 0, 0}, mass{0, 1, 0}, duration{0, 0, 1}, force{1, 1, -2},
    pressure{-1, 1, -2}, energy{2, 1, -2}, power{2, 1, -3}, rate{0, 0, -1};

constexpr std::array<Symbol, 21> symbols = {{
    {"m", {length}, true},
    {"g", {mass, 1.0, -3}, true},
    {"s", {duration}, true},
    {"N", {force}, true},
    {"Pa", {pressure}, true},
    {"J", {energy}, true},
    {"W", {power}, true},
    {"Hz", {rate}, true},
    {"bar", {pressure, 1.0, 5}, true},
    {"t", {mass, 1.0, 3}},
    {"min", {duration, 60.0}},
    {"h", {duration, 3600.0}},
    {"rad", {none}},
    {"deg", {none, 0.017453292519943295}},
    {"in", {length, 254.0, -4}},
    {"ft", {length, 3048.0, -4}},
    {"lb", {mass, 45359237.0, -8}},
    {"lbf", {force, 44482216152605.0, -13}},
    {"psi", {pressure, 6894.757293168361}},
    {"ksi", {pressure, 6894.757293168361, 3}},
    {"1", {none}},
}};

constexpr std::array<std::pair<std::string_view, int>, 12> prefixes = {{
    {"T", 12},
    {"G", 9},
    {"M", 6},
    {"k", 3},
    {"d", -1},
    {"c", -2},
    {"m", -3},
    {"u", -6},
    {"\u00b5", -6},
    {"\u03bc", -6},
    {"n", -9},
    {"p", -12},
}};

std::optional<Unit> symbol_named(std::string_view word) {
  for (const Symbol& symbol : symbols)
    if (symbol.word == word) return symbol.unit;
  for (const auto& [prefix, exponent] : prefixes) {
    if (!word.starts_with(prefix)) continue;
    for (const Symbol& symbol : symbols) {
      if (!symbol.prefixed || symbol.word != word.substr(prefix.size())) continue;
      Unit unit = symbol.unit;
      unit.exponent += exponent;
      return unit;
    }
  }
  return std::nullopt;
}

Unit to_power(const Unit& unit, int times) {
  return {{unit.dimension.length * times, unit.dimension.mass * times, unit.dimension.time * times},
          std::pow(unit.mantissa, times),
          unit.exponent * times};
}

Unit product(const Unit& a, const Unit& b) {
  return {{a.dimension.length + b.dimension.length, a.dimension.mass + b.dimension.mass,
           a.dimension.time + b.dimension.time},
          a.mantissa * b.mantissa,
          a.exponent + b.exponent};
}

/// "mm^2", "mm2", "s^-1".
std::optional<Unit> parse_factor(std::string_view text) {
  const std::size_t end = text.find_first_of("^-0123456789");
  const std::string_view word = text.substr(0, end);
  std::string_view number = end == std::string_view::npos ? "1" : text.substr(end);
  if (number.starts_with('^')) number.remove_prefix(1);
  int exponent = 0;
  const std::from_chars_result read =
      std::from_chars(number.data(), number.data() + number.size(), exponent);
  const std::optional<Unit> unit = word.empty() && text == "1" ? Unit{} : symbol_named(word);
  if (!unit || read.ec != std::errc() || read.ptr != number.data() + number.size())
    return std::nullopt;
  if (exponent < -9 || exponent > 9) return std::nullopt;
  return to_power(*unit, exponent);
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// A unit of the system by its own name, as N or MPa where these are what it is.
std::string named(const Unit& unit) {
  static constexpr std::array<std::pair<std::string_view, Dimension>, 4> names = {
      {{"N", force}, {"Pa", pressure}, {"J", energy}, {"W", power}}};
  for (const auto& [name, dimension] : names) {
    if (unit.dimension != dimension || unit.mantissa != 1.0) continue;
    if (unit.exponent == 0) return std::string(name);
    for (const auto& [prefix, exponent] : prefixes)
      if (exponent == unit.exponent && exponent % 3 == 0) return fmt::format("{}{}", prefix, name);
  }
  return "";
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  Unit unit;
  int sign = 1;
  for (text = trimmed(text);;) {
    const std::size_t end = text.find_first_of("*/");
    const std::optional<Unit> factor = parse_factor(trimmed(text.substr(0, end)));
    if (!factor) return std::nullopt;
    unit = product(unit, to_power(*factor, sign));
    if (end == std::string_view::npos) return unit;
    sign = text[end] == '/' ? -1 : 1;
    text.remove_prefix(end + 1);
  }
}

std::string unit_pattern(std::string_view si_unit) {
  const std::optional<Unit> wanted = parse_unit(si_unit);
  std::vector<std::string_view> begins, prefixed, plain, own, own_prefixed;
  for (const auto& [prefix, exponent] : prefixes) begins.push_back(prefix);
  for (const Symbol& symbol : symbols) {
    if (symbol.word == "1") continue;  // no number has it alone
    (symbol.prefixed ? prefixed : plain).push_back(symbol.word);
    if (wanted && symbol.unit.dimension == wanted->dimension)
      (symbol.prefixed ? own_prefixed : own).push_back(symbol.word);
  }
  const std::string prefix = fmt::format("(?:{})?", fmt::join(begins, "|"));
  const std::string any =
      fmt::format("(?:{}(?:{})|{})", prefix, fmt::join(prefixed, "|"), fmt::join(plain, "|"));
  const std::string power = "\\^?-?[0-9]";
  std::string text = fmt::format("{0}(?:{1})?(?: *[*/] *(?:1|{0}(?:{1})?))+|{0}{1}", any, power);
  if (!own.empty()) text += fmt::format("|{}", fmt::join(own, "|"));
  if (!own_prefixed.empty()) text += fmt::format("|{}(?:{})", prefix, fmt::join(own_prefixed, "|"));
  return "(?:" + text + ")";
}

std::optional<Quantity> split_quantity(std::string_view text) {
  text = trimmed(text);
  double value = 0.0;
  const std::size_t sign = text.starts_with('+') && !text.starts_with("+-") ? 1 : 0;
  const char* begin = text.data() + sign;
  const std::from_chars_result read = std::from_chars(begin, text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr == begin || !std::isfinite(value)) return std::nullopt;
  const std::string_view number(begin, static_cast<std::size_t>(read.ptr - begin));
  const std::string_view unit = trimmed(text.substr(sign + number.size()));
  const auto begins_word = [](unsigned char c) { return std::isalpha(c) || c >= 0x80; };
  if (unit.empty() || !begins_word(static_cast<unsigned char>(unit[0]))) return std::nullopt;
  return Quantity{number, unit};
}

std::optional<double> converted(std::string_view number, const Unit& from, const Unit& to) {
  std::string text(number);
  if (from.mantissa != to.mantissa) {
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    text = fmt::format("{}", value * (from.mantissa / to.mantissa));
  }
  // Ten's power is shifted in the text: the result is the number nearest to what is written.
  const std::size_t mark = text.find_first_of("eE");
  int exponent = from.exponent - to.exponent;
  if (mark != std::string::npos) {
    std::string_view own = std::string_view(text).substr(mark + 1);
    if (own.starts_with('+')) own.remove_prefix(1);
    int power = 0;
    std::from_chars(own.data(), own.data() + own.size(), power);
    exponent += power;
  }
  const std::string shifted = fmt::format("{}e{}", text.substr(0, mark), exponent);
  double value = 0.0;
  const std::from_chars_result read =
      std::from_chars(shifted.data(), shifted.data() + shifted.size(), value);
  if (read.ec != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string dimension_words(const Dimension& dimension) {
  static constexpr std::array<std::pair<Dimension, std::string_view>, 16> known = {{
      {none, "a pure number"},
      {length, "a length"},
      {mass, "a mass"},
      {duration, "a time"},
      {force, "a force"},
      {pressure, "a pressure"},
      {energy, "an energy"},
      {power, "a power"},
      {rate, "a frequency"},
      {{2, 0, 0}, "an area"},
      {{3, 0, 0}, "a volume"},
      {{1, 0, -1}, "a velocity"},
      {{1, 0, -2}, "an acceleration"},
      {{-3, 1, 0}, "a density"},
      {{0, 1, -2}, "a stiffness"},
      {{0, 1, -1}, "an impedance"},
  }};
  for (const auto& [one, words] : known)
    if (one == dimension) return std::string(words);
  return fmt::format("m^{} kg^{} s^{}", dimension.length, dimension.mass, dimension.time);
}

std::optional<UnitSystem> UnitSystem::parse(std::string_view text) {
  UnitSystem system;
  if (trimmed(text) == "SI") return system;
  std::vector<std::string> words;
  std::string word;
  for (const char letter : std::string(text) + ' ') {
    if (letter != ' ' && letter != ',') {
      word += letter;
    } else if (!word.empty()) {
      words.push_back(std::exchange(word, {}));
    }
  }
  std::array<bool, 3> given{};
  for (const std::string& one : words) {
    const std::optional<Unit> unit = parse_unit(one);
    if (!unit) return std::nullopt;
    const auto take = [&](std::size_t k, Unit& own, std::string& name) {
      if (std::exchange(given[k], true)) return false;
      own = *unit;
      name = one;
      return true;
    };
    const bool taken = unit->dimension == length     ? take(0, system.length_, system.length_word_)
                       : unit->dimension == mass     ? take(1, system.mass_, system.mass_word_)
                       : unit->dimension == duration ? take(2, system.time_, system.time_word_)
                                                     : false;
    if (!taken) return std::nullopt;
  }
  if (words.size() != given.size()) return std::nullopt;
  system.words_ =
      fmt::format("{} {} {}", system.length_word_, system.mass_word_, system.time_word_);
  if (system.words_ == "m kg s") system.words_.clear();
  return system;
}

Unit UnitSystem::of(const Dimension& dimension) const {
  return product(to_power(length_, dimension.length),
                 product(to_power(mass_, dimension.mass), to_power(time_, dimension.time)));
}

std::string UnitSystem::word(std::string_view si_unit) const {
  if (is_si()) return std::string(si_unit);
  const std::optional<Unit> unit = parse_unit(si_unit);
  if (!unit || unit->dimension == none) return std::string(si_unit);
  const Dimension& dimension = unit->dimension;
  const std::string name = named(of(dimension));
  if (!name.empty()) return name;
  std::string above, below;
  for (const auto& [word, power] : {std::pair(&mass_word_, dimension.mass),
                                    {&length_word_, dimension.length},
                                    {&time_word_, dimension.time}}) {
    if (power == 0) continue;
    std::string& part = power > 0 ? above : below;
    part += fmt::format("{}{}", part.empty() ? "" : power > 0 ? "*" : "/", *word);
    if (std::abs(power) > 1) part += fmt::format("^{}", std::abs(power));
  }
  if (below.empty()) return above;
  return fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

}  // namespace abut
