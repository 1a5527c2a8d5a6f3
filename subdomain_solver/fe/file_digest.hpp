#pragma once

#include <cstdint>
#include <string>

namespace abut {

/// 64-bit digest of a file's bytes, never 0: equal files, equal digests, on any machine. Throws
/// InputError where the file cannot be read.
std::uint64_t digest_of_file(const std::string& path);

}  // namespace abut
