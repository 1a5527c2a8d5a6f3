#pragma once

#include <string>
#include <string_view>

namespace abut {

/// One word of a shell's command line, whatever is in it, in quotes.
std::string quoted_word(std::string_view text);

/// The same in commands that people read: in quotes only where a shell would take it otherwise.
std::string shell_word(std::string_view text);

}  // namespace abut
