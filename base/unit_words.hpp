#pragma once

#include <map>
#include <string>

#include "base/units.hpp"

namespace abut {

/// "force [N], way [m]" with the words of the system: "force [kN], way [mm]". What else stands in
/// brackets stays.
std::string in_words_of(const UnitSystem& system, const std::string& text);

/// "closes at 12 m/s, at (1, 2) m" with other words for the units of its numbers: "closes at
/// 12 mm/s, at (1, 2) mm". `words`: by those of SI, as unit_words has them; none: the text stays.
std::string quantities_in(const std::map<std::string, std::string>& words, const std::string& text);

/// The system's word for every SI unit that files and tables of a run name.
std::map<std::string, std::string> unit_words(const UnitSystem& system);

/// The same of what a scene says under `units`; empty where these are SI's.
std::map<std::string, std::string> declared_units(const std::string& units);

}  // namespace abut
