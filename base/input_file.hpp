#pragma once

#include <cstddef>
#include <string>

namespace abut {

/// Refuses, before anything is read, what is no file with a size (a folder, a device, a pipe) or is
/// larger than `most` bytes. Throws InputError with the remedy.
void check_input_file(const std::string& path, std::size_t most, const std::string& remedy);

/// The bytes of a file after that check; every text that a scene is made of is read here. A pipe
/// that was handed over open, as /dev/stdin may be, is read up to `most` bytes.
std::string read_input_file(const std::string& path, std::size_t most, const std::string& remedy);

}  // namespace abut
