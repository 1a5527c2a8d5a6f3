#pragma once

#include <map>
#include <string>

#include "base/units.hpp"

namespace abut {

/// "force [N], way [m]" with the words of the system: "force [kN], way [mm]". What else stands in
/// brackets stays.
std::string in_words_of(const UnitSystem& system, const std::string& text);

/// The system's word for every SI unit that files and tables of a run name.
std::map<std::string, std::string> unit_words(const UnitSystem& system);

}  // namespace abut
