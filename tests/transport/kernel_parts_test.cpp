// Goal: kernels of any size cross frames of any size: they come in parts where one frame holds no
// more, and are then what they would have been in one. Oracles: the body in this process; the words
// of the refusal where parts do not follow each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "contract/kernel_parts.hpp"
#include "tests/transport/loop.hpp"

namespace abut::kernel_parts_test {
namespace {

Limits frames_of(std::size_t bytes) {
  Limits limits;
  limits.frame_bytes = bytes;
  return limits;
}

/// A wall of so many points on the line, which a body of one point may meet.
PortGeometry points_on_a_line(int count) {
  PortGeometry wall;
  for (int p = 0; p < count; ++p) {
    wall.points.push_back(0.5 + 0.01 * p);
    wall.normals.push_back(-1.0);
  }
  return wall;
}

/// No two numbers alike.
PortKernel kernel_of(int values, int substeps, ForceSupport support, int points = 0) {
  PortKernel kernel;
  kernel.step = 0.1;
  kernel.support = support;
  kernel.patterns = kernel.width = values;
  for (int p = 0; p < points; ++p) kernel.points.push_back(2 * p);
  const std::size_t all = index(substeps) * kernel.per_step();
  for (std::size_t k = 0; k < all; ++k) {
    kernel.displacement.push_back(std::sin(1.0 + static_cast<double>(k)));
    if (support == ForceSupport::nodal)
      kernel.begin.push_back(std::cos(1.0 + static_cast<double>(k)));
  }
  return kernel;
}

void expect_equal(const PortKernel& got, const PortKernel& sent) {
  EXPECT_EQ(got.step, sent.step);
  EXPECT_EQ(got.support, sent.support);
  EXPECT_EQ(got.patterns, sent.patterns);
  EXPECT_EQ(got.width, sent.width);
  EXPECT_EQ(got.points, sent.points);
  EXPECT_EQ(got.compliance, sent.compliance);
  EXPECT_EQ(got.displacement, sent.displacement);
  EXPECT_EQ(got.begin, sent.begin);
}

TEST(KernelParts, PutTogetherAreTheWhole) {
  for (const ForceSupport support : {ForceSupport::nodal, ForceSupport::step}) {
    for (const int at_once : {1, 2, 3, 7, 8}) {
      PortKernel whole = kernel_of(8, 3, support);
      whole.compliance.assign(64, 0.25);
      PortKernel made = room_for(part_of(whole, 0, 1), 8);
      for (int first = 0; first < 8; first += at_once) {
        const PortKernel part = part_of(whole, first, std::min(at_once, 8 - first));
        ASSERT_TRUE(fits(part, first, made));
        EXPECT_FALSE(fits(part, 8 - part.patterns + 1, made));
        put(part, first, made);
      }
      expect_equal(made, whole);
    }
  }
}

TEST(KernelParts, ProbesOfMorePatternsThanAFrameHoldsAreAskedInParts) {
  std::vector<double> patterns;
  for (int k = 0; k < 1000; ++k) patterns.push_back(1.0 + 0.001 * k);
  // 5 substeps of 1000 patterns, and as much again that might come, are 88 kB.
  for (const std::size_t bytes : {2000, 10'000, 1'000'000}) {
    Loop loop({}, {}, 0, frames_of(bytes));
    loop.configure();
    const PortKernel got = loop.body.probe({0, patterns, 0.01, 5});
    const int requests = loop.fake->counts.kernels;
    expect_equal(got, loop.fake->probe({0, patterns, 0.01, 5}));
    EXPECT_GE(requests * bytes, 88'000u) << bytes;
    EXPECT_LE(requests, bytes >= 1'000'000 ? 1 : 110) << bytes;
  }
}

TEST(KernelParts, OfYieldingPartnersReachTheBodyAsOne) {
  for (const ForceSupport support : {ForceSupport::nodal, ForceSupport::step}) {
    for (const int points : {0, 20}) {  // of all 40, or of a list
      const PortKernel kernel = kernel_of(points > 0 ? points : 40, 3, support, points);
      for (const std::size_t bytes : {3'000, 20'000, 1'000'000}) {
        // Frames are lost, repeated and late: each part counts once.
        const FaultyChannel::Chances rough{.drop = 0.05, .delay = 0.1, .duplicate = 0.2};
        Loop loop(rough, rough, bytes, frames_of(bytes));
        loop.configure();
        const PortGeometry surface = points_on_a_line(40);
        loop.body.meet({0, 0, &surface});
        loop.body.save();  // rides on the first part alone
        loop.body.meet({0, 0, nullptr, {}, &kernel});
        EXPECT_EQ(loop.fake->counts.saves, 1) << bytes;
        EXPECT_EQ(loop.fake->counts.kernels_told, 1) << bytes;
        expect_equal(loop.fake->told, kernel);
        loop.body.meet({0, 0, nullptr, {}, &kernel});  // and again
        EXPECT_EQ(loop.fake->counts.kernels_told, 2) << bytes;
      }
    }
  }
}

TEST(KernelParts, ThatDoNotFollowEachOtherAreRefused) {
  const PortKernel kernel = kernel_of(40, 2, ForceSupport::nodal);
  const auto sent = [&kernel](const std::vector<int>& firsts) {
    Loop loop;
    loop.configure();
    const PortGeometry surface = points_on_a_line(40);
    for (const int partner : {0, 1}) loop.body.meet({0, partner, &surface});
    try {
      for (std::size_t k = 0; k < firsts.size(); ++k) {
        const int partner = k > 0 && firsts[k] == 20 ? 1 : 0;
        const PortKernel part = part_of(kernel, firsts[k], 10);
        encode({0, partner, nullptr, {}, &part}, firsts[k], *loop.caller.request().mutable_meet());
        loop.caller.call("meet");
      }
    } catch (const RunError& error) {
      EXPECT_EQ(loop.fake->counts.kernels_told, 0);
      return error.what_is_wrong;
    }
    return std::string("accepted");
  };
  const std::string refused = "unsound request: meet.first does not follow the parts before";
  EXPECT_EQ(sent({0, 10}), "accepted");
  for (const std::vector<int>& firsts :
       {std::vector<int>{10}, {0, 30}, {0, 10, 10}, {0, 10, 20}})  // the last of another partner
    EXPECT_TRUE(sent(firsts).ends_with(refused)) << sent(firsts);
}

}  // namespace
}  // namespace abut::kernel_parts_test
