#pragma once

#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

/// For libraries that are preloaded into a program and fail one of its calls: the first one of
/// number `after` or later that may fail. Calls are counted once main has begun; before it nobody
/// can be told.
///   FAILING_WORD   a word of the command line: other processes are let be
///   FAILING_AFTER  that number, from 1; 0: none fails
///   FAILING_COUNT  file for the count of calls, written at the end
namespace failing {

using Main = int (*)(int, char**, char**);

inline std::atomic<long> count{0};
inline std::atomic<long> after{0};  // 0: none fails, or no more
inline std::atomic<bool> counts{false};
inline Main program = nullptr;

/// The file of the program or library that an address of code is in.
inline std::string_view file_of(const void* address) {
  Dl_info where{};
  const bool known = dladdr(address, &where) != 0 && where.dli_fname != nullptr;
  return known ? where.dli_fname : "";
}

/// Counts a call; whether it is to fail. `may_fail(file)`: with a caller of that file.
template <class MayFail>
bool now(const void* caller, const MayFail& may_fail) {
  if (!counts.load(std::memory_order_relaxed)) return false;
  const long number = count.fetch_add(1, std::memory_order_relaxed) + 1;
  long least = after.load(std::memory_order_relaxed);
  return least > 0 && number >= least && may_fail(file_of(caller)) &&
         after.compare_exchange_strong(least, 0);
}

inline void tell_count() {
  counts = false;
  const char* path = std::getenv("FAILING_COUNT");
  std::FILE* file = path != nullptr ? std::fopen(path, "w") : nullptr;
  if (file == nullptr) return;
  std::fprintf(file, "%ld\n", count.load());
  std::fclose(file);
}

inline int main_that_counts(int argc, char** argv, char** environment) {
  const char* word = std::getenv("FAILING_WORD");
  const char* number = std::getenv("FAILING_AFTER");
  bool meant = false;
  for (int i = 0; i < argc; ++i) meant = meant || (word && std::strcmp(argv[i], word) == 0);
  if (meant) {
    if (number != nullptr) after = std::atol(number);
    counts = true;
    std::atexit(tell_count);
  }
  return program(argc, argv, environment);
}

/// The function of that name which the program would have called.
template <class Function>
Function original(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace failing

/// Found before that of the C library.
extern "C" inline __attribute__((used)) int __libc_start_main(failing::Main main, int argc,
                                                              char** argv, void (*init)(),
                                                              void (*fini)(), void (*loader_fini)(),
                                                              void* stack_end) {
  using Start = int (*)(failing::Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  failing::program = main;
  return failing::original<Start>("__libc_start_main")(failing::main_that_counts, argc, argv, init,
                                                       fini, loader_fini, stack_end);
}
