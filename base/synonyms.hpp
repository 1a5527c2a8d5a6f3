#pragma once

#include <span>
#include <string>
#include <string_view>

namespace abut {

/// The one of the known keys or words that somebody means who writes another program's word or a
/// formula's letter for it: "E" for youngs_modulus, "explicit" for central_difference. Empty: none.
std::string meant_by(std::string_view word, std::span<const std::string> known);

}  // namespace abut
