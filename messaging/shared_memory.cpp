#include "messaging/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace abut {

namespace {
// Whoever has the file could cut it, and reading beyond its end would end the other process.
constexpr int size_stays = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
}  // namespace

std::unique_ptr<SharedMemory> SharedMemory::map(int descriptor, std::size_t bytes) {
  void* const data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (data == MAP_FAILED) {
    close(descriptor);
    return nullptr;
  }
  return std::unique_ptr<SharedMemory>(
      new SharedMemory(descriptor, static_cast<std::byte*>(data), bytes));
}

std::unique_ptr<SharedMemory> SharedMemory::make(std::size_t bytes) {
  const int descriptor = memfd_create("abut", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor < 0) return nullptr;
  // Taken now: a page that is not there when it is first used would end the process.
  const bool there = posix_fallocate(descriptor, 0, static_cast<off_t>(bytes)) == 0 &&
                     fcntl(descriptor, F_ADD_SEALS, size_stays) == 0;
  if (there) return map(descriptor, bytes);
  close(descriptor);
  return nullptr;
}

std::unique_ptr<SharedMemory> SharedMemory::take(int descriptor) {
  struct stat file {};
  const int seals = fcntl(descriptor, F_GET_SEALS);
  if (seals < 0 || (seals & size_stays) != size_stays || fstat(descriptor, &file) != 0 ||
      file.st_size <= 0)
    return nullptr;
  std::unique_ptr<SharedMemory> memory = map(descriptor, static_cast<std::size_t>(file.st_size));
  if (memory) memory->close_file();
  return memory;
}

void SharedMemory::close_file() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

SharedMemory::~SharedMemory() {
  munmap(data_, size_);
  close_file();
}

}  // namespace abut
