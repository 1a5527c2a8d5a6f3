#include "base/shell_word.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace abut {

namespace {

/// Letters of ASCII, digits, and all of UTF-8's longer characters mean themselves to a shell.
bool means_itself(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code >= 128 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         (c >= '0' && c <= '9') || std::string_view("/._-+=:,@%").find(c) != std::string_view::npos;
}

}  // namespace

std::string quoted_word(std::string_view text) {
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + '\'';
}

std::string shell_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, means_itself) ? std::string(text)
                                                                  : quoted_word(text);
}

}  // namespace abut
