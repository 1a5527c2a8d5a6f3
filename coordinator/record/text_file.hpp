#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/archive.hpp"

namespace abut {

/// A file that grows during a run, written in large pieces. It is made new: one that exists, or a
/// symbolic link of its name, is never written to. Of a resumed run it is there: `goes_on`, and
/// state() tells where. Every failure to write is a RunError.
class TextFile {
 public:
  enum class Opening { made, goes_on };
  explicit TextFile(std::filesystem::path path, Opening opening = Opening::made);

  void append(std::string_view text);  // reaches the file in pieces
  void flush();                        // all of it is in the file now
  /// The text and an ending are in the file now; what comes next takes the ending's place.
  void append_ended(std::string_view text, std::string_view ending);
  void close();
  /// How far it has come. Written, all of it is on the disk; read, what is beyond that is cut off.
  void state(Archive& archive);
  /// Throws RunError where the file does not stand under its name any more: removed, or replaced.
  void check_in_place() const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// Writes a file whole: under a temporary name first, then renamed, so that no reader sees half of
/// it.
void write_whole(const std::filesystem::path& path, std::string_view text);

}  // namespace abut
