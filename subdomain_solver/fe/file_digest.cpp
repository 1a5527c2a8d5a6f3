#include "subdomain_solver/fe/file_digest.hpp"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <limits>
#include <span>
#include <vector>

#include "base/archive.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_file.hpp"

namespace abut {

std::uint64_t digest_of_file(const std::string& path) {
  constexpr const char* remedy = "Check that it is there and readable.";
  check_input_file(path, std::numeric_limits<std::size_t>::max(), remedy);  // a device has no end
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20);  // never the whole of a large file
  std::uint64_t digest = 0;
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const std::size_t count = index(file.gcount());
    digest = hash_combine(digest, hash_bytes(std::as_bytes(std::span(piece.data(), count))));
  }
  if (!file.eof()) throw InputError("cannot be read", path, remedy);
  return std::max<std::uint64_t>(1, digest);
}

}  // namespace abut
