#include "subdomain_solver/fe/gmsh_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

bool is_space(char letter) {
  return letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t';
}

const char* const damaged = "The file is cut short or damaged: export it again.";

/// Text of a file that can be shown.
std::string shown_token(std::string_view text) {
  std::string kept(text.substr(0, 40));
  for (char& letter : kept)
    if (letter < ' ' || letter > '~') letter = '?';
  return kept;
}

}  // namespace

GmshCursor::GmshCursor(std::string bytes, std::string name)
    : bytes_(std::move(bytes)), name_(std::move(name)) {}

std::string GmshCursor::where() const {
  return ever_binary_ ? fmt::format("{}: byte {}", name_, at_) : fmt::format("{}:{}", name_, line_);
}

void GmshCursor::refuse(const std::string& what, const std::string& remedy) const {
  throw InputError(what, where(), remedy);
}

void GmshCursor::begin_binary() {
  if (at_ == bytes_.size()) refuse("ends too early", damaged);
  ++at_;  // line() stopped at the line's end
  binary_ = ever_binary_ = true;
}

void GmshCursor::skip_space() {
  while (at_ < bytes_.size() && is_space(bytes_[at_])) line_ += bytes_[at_++] == '\n' ? 1 : 0;
}

bool GmshCursor::at_end() {
  skip_space();
  return at_ == bytes_.size();
}

std::string_view GmshCursor::line() {
  if (at_end()) refuse("ends too early", damaged);
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string_view text = std::string_view(bytes_).substr(at_, end - at_);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  at_ = end;
  return text;
}

void GmshCursor::expect_line(const std::string& wanted) {
  const std::string_view text = line();
  if (text != wanted)
    refuse(fmt::format("has '{}' where {} must be", shown_token(text), wanted), damaged);
}

void GmshCursor::skip_to(const std::string& text) {
  const std::size_t found = bytes_.find("\n" + text, at_);
  if (found == std::string::npos) refuse("has no " + text, damaged);
  const std::size_t end = std::min(bytes_.find('\n', found + 1), bytes_.size());
  line_ += index(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                            bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  at_ = end;
}

std::string_view GmshCursor::word() {
  if (at_end()) refuse("ends too early", damaged);
  std::size_t end = at_;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  const std::string_view text = std::string_view(bytes_).substr(at_, end - at_);
  at_ = end;
  return text;
}

template <typename Number>
Number GmshCursor::from_bytes() {
  if (bytes_.size() - at_ < sizeof(Number)) refuse("ends too early", damaged);
  Number value;
  std::memcpy(&value, bytes_.data() + at_, sizeof value);
  at_ += sizeof value;
  return value;
}

template <typename Number>
Number GmshCursor::from_text(const char* kind) {
  const std::string_view text = word();
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    refuse(fmt::format("has '{}' where {} must be", shown_token(text), kind), damaged);
  return value;
}

std::int32_t GmshCursor::integer() {
  return binary_ ? from_bytes<std::int32_t>() : from_text<std::int32_t>("a whole number");
}

std::uint64_t GmshCursor::natural() {
  return binary_ ? from_bytes<std::uint64_t>() : from_text<std::uint64_t>("a natural number");
}

double GmshCursor::real() { return binary_ ? from_bytes<double>() : from_text<double>("a number"); }

std::size_t GmshCursor::count(const char* things, std::size_t numbers) {
  const std::uint64_t value = natural();
  const std::size_t least = binary_ ? 4 : 2;  // bytes: an int, or a digit and what separates it
  if (value > (bytes_.size() - at_) / (least * numbers))
    refuse(fmt::format("announces {} {}, more than the rest of it can hold", value, things),
           damaged);
  return index(value);
}

}  // namespace abut
