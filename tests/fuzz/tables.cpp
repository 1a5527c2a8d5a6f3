// Tables of copies. They are read from files, so that an input is written into one in memory.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include <fmt/format.h>

#include "base/yaml_copies_table.hpp"
#include "tests/fuzz/hostile_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace abut;
  static const int file = memfd_create("table", MFD_CLOEXEC);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    std::abort();
  const std::string path = fmt::format("/proc/self/fd/{}", file);
  for (const std::size_t dim : {0, 2})
    fuzz::read_or_refuse([&path, dim] { read_copies_table(path, dim, 10'000); });
  return 0;
}
