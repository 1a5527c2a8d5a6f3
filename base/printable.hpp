#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace abut {

/// Text of somebody else for people: characters that terminals obey, or that turn the direction of
/// text, as \x1b or \u202e, bytes that are no UTF-8 as \xff, and what is longer than `most_bytes`
/// cut, told by "...". New lines stay.
std::string printable(std::string_view text, std::size_t most_bytes = 2000);

}  // namespace abut
