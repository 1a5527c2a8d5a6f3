#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/key.hpp"

namespace abut {

// Single values of a scene, and the words in which messages speak of them. For the reader alone.

/// What a message calls a value.
std::string describe(const YAML::Node& node);
/// A scalar that is not quoted: quotes say that text is meant.
bool is_plain(const YAML::Node& node);
/// YAML writes .nan and .inf; from_chars knows nan and inf as well.
bool is_not_finite(std::string text);
/// What a user may call a body, a port, an interface.
bool is_name(const std::string& text);

/// The number that a text is, all of it.
template <class T>
std::optional<T> parse(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  T value{};
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || text.empty()) return std::nullopt;
  return value;
}

/// Without what is said of it in brackets: "s" of "s (clock)".
std::string_view bare_unit(std::string_view unit);
std::string with_unit(const std::string& text, std::string_view unit);

template <class Strings>
std::string one_of(const Strings& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Of the help only the noun itself fits into a sentence, with its article.
std::string noun(const Key& key);
/// The sentence that says what to write.
std::string remedy(const Key& key, std::string_view form, const Rule& rule = any);

/// The known word that was meant, by its sense or by its letters; empty: none is near.
std::string likely(std::string_view word, std::span<const std::string> known);
/// "Did you mean density? Allowed here: ..."
std::string suggestion(std::string_view word, std::span<const std::string> known,
                       std::string_view lead);

}  // namespace abut
