#pragma once

#include <cstddef>
#include <memory>

namespace abut {

/// Memory of two processes: a file without a name, which no other process can open, whose size
/// nobody can change, and which is gone when the last process that has it is, however it ends.
class SharedMemory {
 public:
  /// Null where this machine gives none: then there are other ways.
  static std::unique_ptr<SharedMemory> make(std::size_t bytes);
  /// What the process that has started this one has made and handed over; takes the descriptor and
  /// closes it. Null where it is no such memory.
  static std::unique_ptr<SharedMemory> take(int descriptor);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::byte* data() { return data_; }
  std::size_t size() const { return size_; }
  /// To hand over; closed in every other child process. -1 once it is closed here.
  int descriptor() const { return descriptor_; }
  /// The memory stays.
  void close_file();

 private:
  SharedMemory(int descriptor, std::byte* data, std::size_t size)
      : descriptor_(descriptor), data_(data), size_(size) {}
  static std::unique_ptr<SharedMemory> map(int descriptor, std::size_t bytes);

  int descriptor_;
  std::byte* data_;
  std::size_t size_;
};

}  // namespace abut
