#include "base/unit_words.hpp"

namespace abut {

std::string in_words_of(const UnitSystem& system, const std::string& text) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', at)) {
    const std::size_t close = text.find(']', open);
    if (close == std::string::npos) break;
    out += text.substr(at, open + 1 - at) + system.word(text.substr(open + 1, close - open - 1));
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
