#pragma once

#include <cstdint>
#include <vector>

#include "coordinator/coupling/bodies.hpp"

namespace abut {

/// What is asked of a port's kernel.
struct KernelWish {
  int body = 0, port = 0;
  int count = 1;                     // of substeps
  std::vector<std::int32_t> points;  // as PortKernel::points
};

/// The kernel at levels of a port whose points answer forces near them alone  [M.152]: as far as
/// the response of one of its points says, and as `largest` [B] allows. Points that are far from
/// each other are pressed at once. No kernel (of no substeps): responses reach too far for that, or
/// so far that `full` [B], the kernel of all points on all others, fits and is not much larger.
PortKernel banded_kernel(const KernelWish& wish, double largest, double full, Bodies& bodies);

}  // namespace abut
