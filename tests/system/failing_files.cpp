// Preloaded into a program, it fails one call by which the program itself writes a file, or has it
// on the disk, or renames it (failing_once.hpp): the disk is full at that moment. What libraries
// write (to sockets, to a terminal) is let be.
#include "tests/system/failing_once.hpp"

#include <sys/types.h>
#include <unistd.h>

#include <cerrno>

namespace {

/// Of the standard library: std::filesystem renames.
bool fails(const void* caller) {
  const bool now = failing::now(caller, [](std::string_view file) {
    const std::string_view name = file.substr(file.rfind('/') + 1);
    return name == "abut" || name.starts_with("libstdc++");
  });
  if (now) errno = ENOSPC;
  return now;
}

}  // namespace

extern "C" {

size_t fwrite(const void* data, size_t size, size_t count, std::FILE* file) {
  if (fails(__builtin_return_address(0))) return 0;
  return failing::original<decltype(&fwrite)>("fwrite")(data, size, count, file);
}

int fflush(std::FILE* file) {
  if (fails(__builtin_return_address(0))) return EOF;
  return failing::original<decltype(&fflush)>("fflush")(file);
}

int fclose(std::FILE* file) {
  const bool fails_now = fails(__builtin_return_address(0));
  const int code = failing::original<decltype(&fclose)>("fclose")(file);
  if (fails_now) errno = ENOSPC;
  return fails_now ? EOF : code;
}

ssize_t write(int descriptor, const void* data, size_t size) {
  if (fails(__builtin_return_address(0))) return -1;
  return failing::original<decltype(&write)>("write")(descriptor, data, size);
}

int fsync(int descriptor) {
  if (fails(__builtin_return_address(0))) return -1;
  return failing::original<decltype(&fsync)>("fsync")(descriptor);
}

int fdatasync(int descriptor) {
  if (fails(__builtin_return_address(0))) return -1;
  return failing::original<decltype(&fdatasync)>("fdatasync")(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  if (fails(__builtin_return_address(0))) return -1;
  return failing::original<int (*)(const char*, const char*)>("rename")(from, to);
}

}  // extern "C"
