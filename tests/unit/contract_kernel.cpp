#include "contract/kernel.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "contract/kernel_parts.hpp"

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

/// Three points of two components on a line; each answers itself and its neighbours, over two
/// substeps. Beside it the same with zeros between points that do not answer each other.
std::pair<PortKernel, PortKernel> banded_and_full() {
  PortKernel banded, full;
  banded.patterns = banded.width = full.patterns = full.width = 6;
  banded.band.dim = 2;
  banded.band.offsets = {0, 2, 5, 7};
  banded.band.reached = {0, 1, 0, 1, 2, 1, 2};
  full.displacement.assign(72, 0.0);
  double value = 0.1;
  for (std::size_t step = 0; step < 2; ++step)
    for (std::size_t p = 0; p < 3; ++p)
      for (const std::int32_t q : banded.band.of(p))
        for (std::size_t j = 0; j < 2; ++j)
          for (std::size_t i = 0; i < 2; ++i) {
            banded.displacement.push_back(value);
            full.displacement[(step * 6 + 2 * p + j) * 6 + 2 * index(q) + i] = value;
            value = -1.3 * value + 0.01;
          }
  banded.begin = banded.displacement;
  full.begin = full.displacement;
  return {banded, full};
}

// Goal: a banded kernel moves what the kernel of all points with zeros does, to the last bit: the
// same products in the same order.
TEST(ContractKernel, BandedMovesAsFullDoes) {
  const auto [banded, full] = banded_and_full();
  ASSERT_EQ(banded.count(), 2);
  const std::vector<double> forces = {1.7, -0.4, 0.0, 2.5, -3.1, 0.6};
  for (int lag = 0; lag < 2; ++lag) {
    std::vector<double> one(6, 0.25), other(6, 0.25);
    add_response(banded, lag, false, -0.7, forces, one);
    add_response(full, lag, false, -0.7, forces, other);
    EXPECT_EQ(one, other);
  }
}

// Goal: a banded kernel that is cut into parts, point by point, and put together is the same one;
// parts that do not follow each other are told.
TEST(ContractKernel, PartsOfABandMakeItAgain) {
  const auto [banded, full] = banded_and_full();
  PortKernel made = room_for(part_of(banded, 0, 2), 6);
  for (int first = 0; first < 6; first += 2) {
    const PortKernel part = part_of(banded, first, 2);
    EXPECT_FALSE(fits(part, first == 0 ? 2 : 0, made));
    ASSERT_TRUE(fits(part, first, made));
    put(part, first, made);
  }
  EXPECT_EQ(made.displacement, banded.displacement);
  EXPECT_EQ(made.begin, banded.begin);
  EXPECT_EQ(made.band.offsets, banded.band.offsets);
  EXPECT_EQ(made.band.reached, banded.band.reached);
  EXPECT_FALSE(fits(part_of(full, 0, 2), 0, room_for(part_of(banded, 0, 2), 6)));
  EXPECT_FALSE(fits(part_of(banded, 0, 2), 0, room_for(part_of(full, 0, 2), 6)));
}

}  // namespace
}  // namespace abut::contract_kernel_tests
