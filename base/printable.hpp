#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace abut {

/// Text of somebody else for people: control characters, which terminals obey, as \x1b, and what
/// is longer than `most_bytes` cut, told by "...". New lines stay.
std::string printable(std::string_view text, std::size_t most_bytes = 2000);

}  // namespace abut
