#include "coordinator/record/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace abut {
namespace {

constexpr std::size_t piece = std::size_t{1} << 17;  // bytes: few system calls, little to lose

/// Never an existing file, and never the target of a symbolic link.
std::FILE* create(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return nullptr;
  std::FILE* file = fdopen(descriptor, "wb");
  if (file == nullptr) close(descriptor);
  return file;
}

/// A file, and never the target of a symbolic link.
std::FILE* open_again(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  std::FILE* file = fdopen(descriptor, "wb");
  if (file == nullptr) close(descriptor);
  return file;
}

}  // namespace

TextFile::TextFile(std::filesystem::path path, Opening opening)
    : path_(std::move(path)), file_(opening == Opening::made ? create(path_) : open_again(path_)) {
  if (!file_) fail(opening == Opening::made ? "made" : "opened");
  if (std::setvbuf(file_.get(), nullptr, _IOFBF, piece) != 0) fail("buffered");
}

void TextFile::append(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail("written");
}

void TextFile::flush() {
  if (std::fflush(file_.get()) != 0) fail("written");
}

void TextFile::append_ended(std::string_view text, std::string_view ending) {
  append(text);
  append(ending);
  flush();
  if (std::fseek(file_.get(), -static_cast<long>(ending.size()), SEEK_CUR) != 0) fail("written");
}

void TextFile::close() {
  if (!file_) return;
  if (std::fclose(file_.release()) != 0) fail("written");
}

void TextFile::state(Archive& archive) {
  std::int64_t bytes = 0;
  if (archive.writing()) {
    flush();
    bytes = std::ftell(file_.get());
    if (bytes < 0 || fdatasync(fileno(file_.get())) != 0) fail("written");
  }
  archive.field("bytes", bytes);
  if (archive.writing()) return;
  struct stat held {};
  if (fstat(fileno(file_.get()), &held) != 0) fail("read");
  if (bytes < 0 || held.st_size < bytes)
    throw RunError(
        fmt::format("has {} bytes; the checkpoint was written when it had {}", held.st_size, bytes),
        path_.string(), "Put the run's files back as they were, or run again.");
  if (ftruncate(fileno(file_.get()), bytes) != 0 ||
      std::fseek(file_.get(), static_cast<long>(bytes), SEEK_SET) != 0)
    fail("written");
}

void TextFile::check_in_place() const {
  if (!file_) return;
  struct stat held {
  }, named{};
  const bool same = fstat(fileno(file_.get()), &held) == 0 && stat(path_.c_str(), &named) == 0 &&
                    held.st_dev == named.st_dev && held.st_ino == named.st_ino;
  if (!same)
    throw RunError("was removed or replaced while the run wrote it", path_.string(),
                   "Run again, and leave the run's folder alone until the run has ended.");
}

void TextFile::fail(const char* doing) const {
  throw RunError(fmt::format("cannot be {}: {}", doing, std::strerror(errno)), path_.string(),
                 "Check that the folder exists, is writable and has space left.");
}

void write_whole(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  std::error_code error;
  std::filesystem::remove(temporary, error);  // what a run that was killed has left
  try {
    TextFile file(temporary);
    file.append(text);
    file.close();
    std::filesystem::rename(temporary, path, error);
    if (error)
      throw RunError(fmt::format("cannot be renamed to {}: {}", path.string(), error.message()),
                     temporary.string(), "Check that nothing else uses the run's folder.");
  } catch (...) {  // nothing of it stays
    std::filesystem::remove(temporary, error);
    throw;
  }
}

}  // namespace abut
