#include "base/unit_words.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

namespace abut {
namespace {

std::string with(std::string text, char old, char fresh) {
  std::replace(text.begin(), text.end(), old, fresh);
  return text;
}

/// Products are written with a blank here, kg m/s, and so is their word.
std::string word_of(const UnitSystem& system, const std::string& unit) {
  const std::string product = with(unit, ' ', '*'), word = system.word(product);
  return word == product ? unit : with(word, '*', ' ');
}

bool ends_word(std::string_view text, std::size_t at) {
  if (at >= text.size()) return true;
  const unsigned char next = static_cast<unsigned char>(text[at]);
  return std::isalnum(next) == 0 && next < 0x80 &&
         std::string_view("^*/_").find(text[at]) == std::string_view::npos;
}

/// The longest unit that stands at a place of a text; null: none does.
const std::pair<const std::string, std::string>* unit_at(
    const std::map<std::string, std::string>& words, std::string_view text, std::size_t at) {
  const std::pair<const std::string, std::string>* longest = nullptr;
  for (const auto& entry : words) {
    const std::string& unit = entry.first;
    if (with(std::string(text.substr(at, unit.size())), ' ', '*') != unit) continue;
    if (!ends_word(text, at + unit.size())) continue;
    if (longest == nullptr || unit.size() > longest->first.size()) longest = &entry;
  }
  return longest;
}

}  // namespace

std::string quantities_in(const std::map<std::string, std::string>& words,
                          const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    out += text[at];
    if (text[at] != ' ' || at == 0) continue;
    const char before = text[at - 1];
    if (std::isdigit(static_cast<unsigned char>(before)) == 0 && before != ')') continue;
    const auto* unit = unit_at(words, text, at + 1);
    if (unit == nullptr) continue;
    out += with(unit->second, '*', ' ');
    at += unit->first.size();
  }
  return out;
}

std::string in_words_of(const UnitSystem& system, const std::string& text) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', at)) {
    const std::size_t close = text.find(']', open);
    if (close == std::string::npos) break;
    out +=
        text.substr(at, open + 1 - at) + word_of(system, text.substr(open + 1, close - open - 1));
    at = close;
  }
  return out + text.substr(at);
}

std::map<std::string, std::string> unit_words(const UnitSystem& system) {
  std::map<std::string, std::string> words;
  for (const char* unit : {"m", "s", "kg", "m/s", "m/s^2", "N", "Pa", "J", "W", "Hz", "N*s", "N*m",
                           "kg*m/s", "kg/m^3", "m^2", "N/m"})
    words[unit] = system.word(unit);
  return words;
}

std::map<std::string, std::string> declared_units(const std::string& units) {
  const std::optional<UnitSystem> system = UnitSystem::parse(units);
  if (!system || system->is_si()) return {};
  return unit_words(*system);
}

}  // namespace abut
