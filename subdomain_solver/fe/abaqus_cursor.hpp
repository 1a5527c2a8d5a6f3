#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace abut {

/// A line of an input file or of one that it includes.
struct AbaqusLine {
  std::int32_t file = 0, number = 0;
};

/// A keyword line, with its parameters.
struct AbaqusCard {
  std::string keyword;  // "SOLID SECTION"
  std::map<std::string, std::string, std::less<>>
      parameters;  // keys in capitals, values as written
  AbaqusLine line;

  bool has(std::string_view key) const { return parameters.contains(key); }
  /// The value of a parameter; empty where it is not there or has none.
  std::string value(std::string_view key) const;
};

/// In capitals: keywords and names are the same in any case.
std::string in_capitals(std::string_view text);

/// Walks through an Abaqus or CalculiX input file (.inp): keyword lines and their data lines,
/// without comments and blank lines, in the files of *INCLUDE as well, whose paths are relative to
/// the file that has them. Throws InputError with file and line.
class AbaqusCursor {
 public:
  /// `name` is the file's path.
  AbaqusCursor(std::string bytes, const std::string& name);

  /// The next keyword, after data lines that were not asked for; false at the end.
  bool next_card(AbaqusCard& card);
  /// The fields of the next data line of the card, without blanks around them, an empty one behind
  /// the last comma left out; false where the next keyword or the end is. They last as the cursor.
  bool next_data(std::vector<std::string_view>& fields);
  /// Data lines come from another file from here on, up to its end: what INPUT= says.
  void read_from(const std::string& path);

  AbaqusLine line() const { return at_; }
  std::string where(AbaqusLine line) const;
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;
  std::int64_t integer(std::string_view field, const char* what) const;
  /// Also as Fortran writes it, 1.0D-3; nothing is 0, as there.
  double real(std::string_view field) const;
  /// Of all files so far, the first the file itself.
  std::vector<std::string> files() const;

 private:
  struct File {
    std::string path, bytes;
    std::size_t at = 0;
    std::int32_t line = 0;
  };

  bool look();  // fills ahead_ with the next line that says something; false at the end
  AbaqusCard card_of(std::string_view text);

  std::deque<File> files_;
  std::vector<std::int32_t> open_;  // those being read, the innermost last
  std::string_view ahead_;
  AbaqusLine at_, ahead_at_;
  bool has_ahead_ = false;
};

}  // namespace abut
