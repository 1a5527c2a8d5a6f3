#include "base/denormals.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace abut {

#if defined(__SSE2__)

namespace {
constexpr unsigned flush_results = 0x8000, flush_operands = 0x0040;  // of MXCSR
}

FlushedDenormals::FlushedDenormals() : before_(_mm_getcsr()) {
  _mm_setcsr(static_cast<unsigned>(before_) | flush_results | flush_operands);
}
FlushedDenormals::~FlushedDenormals() { _mm_setcsr(static_cast<unsigned>(before_)); }

#elif defined(__aarch64__)

namespace {
constexpr unsigned long flush = 1UL << 24;  // FZ of FPCR
}

FlushedDenormals::FlushedDenormals() {
  asm volatile("mrs %0, fpcr" : "=r"(before_));
  asm volatile("msr fpcr, %0" : : "r"(before_ | flush));
}
FlushedDenormals::~FlushedDenormals() { asm volatile("msr fpcr, %0" : : "r"(before_)); }

#else

FlushedDenormals::FlushedDenormals() = default;
FlushedDenormals::~FlushedDenormals() = default;

#endif

}  // namespace abut
