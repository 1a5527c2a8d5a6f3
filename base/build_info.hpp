#pragma once

#include <string>
#include <string_view>

namespace abut {

/// What a program was built from, for `--version` and the files of a run.
struct BuildInfo {
  std::string_view version;   // "0.1.0"
  std::string_view commit;    // twelve digits; "+ changes" where files differed; "unknown"
  std::string_view options;   // "Release; optional libraries: none"
  std::string_view compiler;  // "GNU 12.2.0"
};

/// Defined in one small file of the build folder, which is all that a new commit compiles again.
extern const BuildInfo build_info;

/// What `program --version` prints, without the last newline: the program's name and version in the
/// first line, and `more` beside them.
std::string version_text(std::string_view program, std::string_view more = {});

}  // namespace abut
