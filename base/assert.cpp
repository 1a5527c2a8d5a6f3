#include "base/assert.hpp"

#include <cstdio>
#include <cstdlib>

namespace abut {

void assertion_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken invariant: %s\n", file, line, expression);
  std::fflush(nullptr);
  std::abort();
}

}  // namespace abut
