// Preloaded into a program, it fails one allocation of an operator new (failing_once.hpp). Those of
// libzmq are let be: it ends a program without memory, and lets nobody catch that.
#include "tests/system/failing_once.hpp"

#include <new>

namespace {

bool fails(const void* caller) {
  return failing::now(
      caller, [](std::string_view file) { return file.find("libzmq") == std::string_view::npos; });
}

void* take(std::size_t size) { return std::malloc(size > 0 ? size : 1); }

void* take_aligned(std::size_t size, std::align_val_t alignment) {
  const std::size_t unit = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Those that answer with a null pointer fail nowhere: who asks them has another way, or libzmq's.
void* operator new(std::size_t size) {
  if (fails(__builtin_return_address(0))) throw std::bad_alloc();
  return or_throw(take(size));
}
void* operator new[](std::size_t size) {
  if (fails(__builtin_return_address(0))) throw std::bad_alloc();
  return or_throw(take(size));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (fails(__builtin_return_address(0))) throw std::bad_alloc();
  return or_throw(take_aligned(size, alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  if (fails(__builtin_return_address(0))) throw std::bad_alloc();
  return or_throw(take_aligned(size, alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
