#include "subdomain_solver/fe/abaqus_cursor.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_file.hpp"
#include "base/machine_memory.hpp"

namespace abut {
namespace {

constexpr std::size_t most_files = 200;  // a file that includes itself never ends

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\f\v";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Text of a file that can be shown.
std::string shown_field(std::string_view text) {
  std::string kept(text.substr(0, 40));
  for (char& letter : kept)
    if (letter < ' ' || letter > '~') letter = '?';
  return kept;
}

/// A keyword in capitals, with single blanks: "*Solid  section" is SOLID SECTION.
std::string keyword_of(std::string_view text) {
  std::string word;
  for (char letter : in_capitals(trimmed(text))) {
    const bool blank = letter == ' ' || letter == '\t';
    if (!blank) word += letter;
    if (blank && !word.empty() && word.back() != ' ') word += ' ';
  }
  return word;
}

/// Parts between commas that are not in quotes.
std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    if (k < text.size() && text[k] == '"') quoted = !quoted;
    if (k < text.size() && (text[k] != ',' || quoted)) continue;
    parts.push_back(trimmed(text.substr(begin, k - begin)));
    begin = k + 1;
  }
  return parts;
}

std::string_view without_quotes(std::string_view text) {
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

std::string in_capitals(std::string_view text) {
  std::string out(text);
  for (char& letter : out)
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return out;
}

std::string AbaqusCard::value(std::string_view key) const {
  const auto found = parameters.find(key);
  return found == parameters.end() ? std::string() : found->second;
}

AbaqusCursor::AbaqusCursor(std::string bytes, const std::string& name) {
  files_.push_back({name, std::move(bytes)});
  open_.push_back(0);
  at_ = {0, 1};
  if (!look() || ahead_.front() != '*')
    refuse("is no input file of Abaqus or CalculiX: it does not begin with a keyword, as *NODE",
           "Give an .inp file, as text; a mesh of Gmsh (.msh) is read by mesh: gmsh.");
}

std::string AbaqusCursor::where(AbaqusLine line) const {
  return fmt::format("{}:{}", files_[index(line.file)].path, line.number);
}

void AbaqusCursor::refuse(const std::string& what, const std::string& remedy) const {
  throw InputError(what, where(at_), remedy);
}

void AbaqusCursor::read_from(const std::string& path) {
  if (path.empty()) refuse("names no file to read from", "Write INPUT=FILE.");
  if (files_.size() >= most_files)
    refuse(fmt::format("includes more than {} files", most_files),
           "Does a file include itself? Take that line out.");
  const std::string& own = files_[index(at_.file)].path;
  const std::string whole = path.starts_with('/') ? path : own.substr(0, own.rfind('/') + 1) + path;
  try {
    const std::size_t most = static_cast<std::size_t>(0.5 * machine_memory());
    constexpr const char* remedy = "Put the file there, or write its lines here.";
    check_input_file(whole, most, remedy);
    files_.push_back({whole, read_input_file(whole, most, remedy)});
  } catch (const InputError& error) {
    refuse(fmt::format("includes {}, which {}", whole, error.what_is_wrong), error.remedy);
  }
  // what was looked at already comes after the file
  if (has_ahead_) {
    File& file = files_[index(ahead_at_.file)];
    file.at = index(ahead_.data() - file.bytes.data());
    file.line = ahead_at_.number - 1;
    if (open_.empty() || open_.back() != ahead_at_.file) open_.push_back(ahead_at_.file);
    has_ahead_ = false;
  }
  open_.push_back(static_cast<std::int32_t>(files_.size()) - 1);
}

bool AbaqusCursor::look() {
  while (!has_ahead_ && !open_.empty()) {
    File& file = files_[index(open_.back())];
    if (file.at >= file.bytes.size()) {
      open_.pop_back();
      continue;
    }
    const std::size_t end = std::min(file.bytes.find('\n', file.at), file.bytes.size());
    const std::string_view text =
        trimmed(std::string_view(file.bytes).substr(file.at, end - file.at));
    file.at = end + 1;
    ++file.line;
    if (text.empty() || text.starts_with("**")) continue;
    ahead_ = text;
    ahead_at_ = {open_.back(), file.line};
    has_ahead_ = true;
    if (text.front() != '*' || keyword_of(split(text)[0]) != "*INCLUDE") continue;
    has_ahead_ = false;
    at_ = ahead_at_;
    read_from(card_of(text).value("INPUT"));
  }
  return has_ahead_;
}

AbaqusCard AbaqusCursor::card_of(std::string_view text) {
  AbaqusCard card;
  card.line = at_;
  std::vector<std::string_view> parts = split(text);
  card.keyword = keyword_of(parts[0].substr(1));
  // a keyword line that ends with a comma goes on
  while (parts.size() > 1 && parts.back().empty() && look() && ahead_.front() != '*') {
    parts.pop_back();
    for (std::string_view more : split(ahead_)) parts.push_back(more);
    at_ = ahead_at_;
    has_ahead_ = false;
  }
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].empty()) continue;
    const std::size_t equal = parts[k].find('=');
    const std::string key = keyword_of(parts[k].substr(0, equal));
    const std::string_view value =
        equal == std::string_view::npos ? "" : trimmed(parts[k].substr(equal + 1));
    card.parameters[key] = without_quotes(value);
  }
  return card;
}

bool AbaqusCursor::next_card(AbaqusCard& card) {
  while (look()) {
    at_ = ahead_at_;
    has_ahead_ = false;
    if (ahead_.front() != '*') continue;
    card = card_of(ahead_);
    return true;
  }
  return false;
}

bool AbaqusCursor::next_data(std::vector<std::string_view>& fields) {
  fields.clear();
  if (!look() || ahead_.front() == '*') return false;
  at_ = ahead_at_;
  has_ahead_ = false;
  fields = split(ahead_);
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  for (std::string_view& field : fields) field = without_quotes(field);
  return true;
}

std::int64_t AbaqusCursor::integer(std::string_view field, const char* what) const {
  std::int64_t value = 0;
  const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < 1)
    refuse(fmt::format("has '{}' where {} must be", shown_field(field), what),
           "Write whole numbers from 1 on, with commas between them.");
  return value;
}

double AbaqusCursor::real(std::string_view field) const {
  if (field.empty()) return 0.0;
  const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
  std::array<char, 64> text{};
  const std::size_t size = std::min(digits.size(), text.size());
  std::copy_n(digits.begin(), size, text.begin());
  for (char& letter : text)
    if (letter == 'd' || letter == 'D') letter = 'e';
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + size, value);
  const bool whole = size == digits.size() && end == text.data() + size;
  if (error != std::errc() || !whole || !std::isfinite(value))
    refuse(fmt::format("has '{}' where a number must be", shown_field(field)),
           "Write numbers as 1.5e-3 or 1.5D-3, with commas between them.");
  return value;
}

std::vector<std::string> AbaqusCursor::files() const {
  std::vector<std::string> paths;
  for (const File& file : files_) paths.push_back(file.path);
  return paths;
}

}  // namespace abut
