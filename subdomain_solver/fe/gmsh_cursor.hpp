#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace abut {

/// Walks through the bytes of a Gmsh file: lines, and numbers that are text or binary. Whatever
/// does not fit is refused by InputError with the line, or in binary parts the byte, in the file.
class GmshCursor {
 public:
  /// `name` is the file's, for messages.
  GmshCursor(std::string bytes, std::string name);

  /// True when only white space is left.
  bool at_end();
  /// The next line that is not blank, without white space around it.
  std::string_view line();
  /// The next line must be this one.
  void expect_line(const std::string& wanted);
  /// Goes behind the next line that begins with `text`, wherever it is.
  void skip_to(const std::string& text);

  /// Numbers are binary from here on, beginning on the next line; or text again.
  void begin_binary();
  void end_binary() { binary_ = false; }
  std::int32_t integer();   // 4 bytes
  std::uint64_t natural();  // 8 bytes
  double real();            // 8 bytes
  /// A natural number of things that each take at least `numbers` numbers: never more than the rest
  /// of the file can hold, so that it can be allocated.
  std::size_t count(const char* things, std::size_t numbers);

  /// "part.msh:12", or "part.msh: byte 345" in a file with binary parts, in which lines do not
  /// count.
  std::string where() const;
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;

 private:
  void skip_space();
  std::string_view word();
  template <typename Number>
  Number from_bytes();
  template <typename Number>
  Number from_text(const char* kind);

  std::string bytes_, name_;
  std::size_t at_ = 0, line_ = 1;
  bool binary_ = false, ever_binary_ = false;
};

}  // namespace abut
