#include "contract/kernel.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace abut::contract_kernel_tests {
namespace {

/// Three substeps, patterns of 2 values and responses of 3; every entry is another number.
PortKernel kernel() {
  PortKernel out;
  out.patterns = 2;
  out.width = 3;
  for (int k = 0; k < 18; ++k) {
    out.displacement.push_back(0.1 + 0.37 * k);
    out.begin.push_back(-0.2 - 0.53 * k * k);
  }
  return out;
}

// Goal: a term of the convolution is sign * sum over patterns of force times response, entry by
// entry. Oracle: the definition of the arrays of PortKernel, (n, patterns, width); bits, because
// the same products are summed in the same order.
TEST(ContractKernel, TermIsForceTimesResponseAtItsLag) {
  const PortKernel k = kernel();
  const std::vector<double> forces = {1.7, -0.4};
  for (const bool at_begin : {false, true}) {
    const std::vector<double>& of = at_begin ? k.begin : k.displacement;
    for (int lag = 0; lag < k.count(); ++lag) {
      for (const double sign : {1.0, -1.0, 0.3}) {
        std::vector<double> out = {5.0, 6.0, 7.0}, expected = out;
        for (std::size_t p = 0; p < 2; ++p)
          for (std::size_t v = 0; v < 3; ++v)
            expected[v] += sign * forces[p] * of[(index(lag) * 2 + p) * 3 + v];
        add_response(k, lag, at_begin, sign, forces, out);
        EXPECT_EQ(out, expected) << "lag " << lag << ", sign " << sign;
      }
    }
  }
}

// Goal: what has no force is not looked at: kernels may hold anything there, and it costs nothing.
TEST(ContractKernel, ForcesThatAreZeroAddNothing) {
  PortKernel k = kernel();
  for (std::size_t v = 0; v < 3; ++v) k.displacement[v] = std::numeric_limits<double>::infinity();
  std::vector<double> out = {1.0, 2.0, 3.0};
  add_response(k, 0, false, 1.0, std::vector<double>{0.0, 0.0}, out);
  EXPECT_EQ(out, (std::vector<double>{1.0, 2.0, 3.0}));
  add_response(k, 0, false, 1.0, std::vector<double>{0.0, 1.0}, out);
  for (std::size_t v = 0; v < 3; ++v)
    EXPECT_EQ(out[v], 1.0 + static_cast<double>(v) + k.displacement[3 + v]);
}

}  // namespace
}  // namespace abut::contract_kernel_tests
