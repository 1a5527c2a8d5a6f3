// Preloaded into a program, it fails one allocation: the first one of number `after` or later that
// an operator new is asked for once main has begun (before it nobody can be told) and that is not
// libzmq's own, which ends a program without memory and lets nobody catch that.
//   FAILING_MEMORY_WORD   a word of the command line: other processes have memory
//   FAILING_MEMORY_AFTER  that number, from 1; above all: none fails
//   FAILING_MEMORY_COUNT  file for the count of allocations, written at the end
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

using Main = int (*)(int, char**, char**);

std::atomic<long> count{0};
std::atomic<long> after{-1};  // none fails
std::atomic<bool> counts{false};
Main program = nullptr;

bool asked_by_libzmq(const void* caller) {
  Dl_info where{};
  return dladdr(caller, &where) != 0 && where.dli_fname != nullptr &&
         std::strstr(where.dli_fname, "libzmq") != nullptr;
}

bool fails(const void* caller) {
  if (!counts.load(std::memory_order_relaxed)) return false;
  const long number = count.fetch_add(1, std::memory_order_relaxed) + 1;
  long least = after.load(std::memory_order_relaxed);
  return least > 0 && number >= least && !asked_by_libzmq(caller) &&
         after.compare_exchange_strong(least, -1);
}

void tell_count() {
  counts = false;
  const char* path = std::getenv("FAILING_MEMORY_COUNT");
  std::FILE* file = path != nullptr ? std::fopen(path, "w") : nullptr;
  if (file == nullptr) return;
  std::fprintf(file, "%ld\n", count.load());
  std::fclose(file);
}

int main_that_counts(int argc, char** argv, char** environment) {
  const char* word = std::getenv("FAILING_MEMORY_WORD");
  const char* number = std::getenv("FAILING_MEMORY_AFTER");
  bool meant = false;
  for (int i = 0; i < argc; ++i) meant = meant || (word && std::strcmp(argv[i], word) == 0);
  if (meant) {
    if (number != nullptr) after = std::atol(number);
    counts = true;
    std::atexit(tell_count);
  }
  return program(argc, argv, environment);
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

extern "C" int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                                 void (*loader_fini)(), void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program = main;
  const Start start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(main_that_counts, argc, argv, init, fini, loader_fini, stack_end);
}

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
