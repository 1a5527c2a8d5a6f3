#include "base/input_file.hpp"

#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <sys/vfs.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr long pipes = 0x50495045;  // the file system of pipes without names (linux/magic.h)

[[noreturn]] void refuse_size(const std::string& path, std::size_t most,
                              const std::string& remedy) {
  throw InputError(fmt::format("is larger than {} MB", most / 1'000'000), path, remedy);
}

/// A pipe without a name, as /dev/stdin may be: it was handed over open, and ends with its writer.
/// One with a name waits for a writer as soon as it is opened, for ever where there is none.
bool is_open_pipe(const std::string& path) {
  struct statfs system {};
  return statfs(path.c_str(), &system) == 0 && system.f_type == pipes;
}

}  // namespace

void check_input_file(const std::string& path, std::size_t most, const std::string& remedy) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError("cannot be opened", path, remedy);
  if (fs::is_directory(status)) throw InputError("is a folder, not a file", path, remedy);
  if (!fs::is_regular_file(status))
    throw InputError("is a device or a pipe, not a file", path, remedy);
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError("cannot be opened", path, remedy);
  if (size > most) refuse_size(path, most, remedy);
}

std::string read_input_file(const std::string& path, std::size_t most, const std::string& remedy) {
  if (!is_open_pipe(path)) check_input_file(path, most, remedy);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError("cannot be opened", path, remedy);
  std::string bytes;
  std::array<char, 65536> part{};
  while (file.read(part.data(), part.size()) || file.gcount() > 0) {
    bytes.append(part.data(), index(file.gcount()));
    if (bytes.size() > most) refuse_size(path, most, remedy);
  }
  if (file.bad()) throw InputError("cannot be read", path, remedy);
  return bytes;
}

}  // namespace abut
