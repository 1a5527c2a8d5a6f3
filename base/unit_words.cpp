#include "base/unit_words.hpp"

#include <algorithm>

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

}  // namespace

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

}  // namespace abut
