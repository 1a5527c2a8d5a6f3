#define ABUT_DENSE_KERNELS template
#include "base/dense_kernels.hpp"
