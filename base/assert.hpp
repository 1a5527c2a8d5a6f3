#pragma once

namespace abut {
/// Prints the broken invariant and aborts.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}  // namespace abut

/// Our own invariants, checked in every build.
#define ABUT_ASSERT(expression) \
  ((expression) ? void(0) : ::abut::assertion_failed(#expression, __FILE__, __LINE__))
