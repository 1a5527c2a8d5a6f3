// Goal: however the transport mistreats messages, a body does what it was asked, once and in order.
// Oracle: the same calls on a body without any transport: equal state hash, equal counts.
#include <gtest/gtest.h>

#include "contract/no_answer.hpp"
#include "tests/transport/loop.hpp"

namespace abut::at_most_once_test {
namespace {

/// Windows with one rewind each; returns the last response's end displacement.
double play(Subdomain& body, int windows) {
  Response response;
  for (int window = 0; window < windows; ++window) {
    const Advance advance = request_for(window);
    body.save();
    EXPECT_TRUE(std::holds_alternative<Advanced>(body.advance(advance, response)));
    body.restore();
    EXPECT_TRUE(std::holds_alternative<Advanced>(body.advance(advance, response)));
  }
  return response.ports.at(0).trace.u.back();
}

TEST(Transport, RunsEveryRequestOnceUnderAThousandSeedsOfFaults) {
  FakeSubdomain local;
  const double expected = play(local, 10);
  const std::uint64_t hash = local.state_hash();
  FaultyChannel::Counts total;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const FaultyChannel::Chances rough{
        .drop = 0.1, .delay = 0.15, .duplicate = 0.15, .corrupt = 0.05};
    Loop loop(rough, rough, 2 * seed);
    loop.configure();
    ASSERT_EQ(play(loop.body, 10), expected) << "seed " << seed;
    ASSERT_EQ(loop.body.state_hash(), hash) << "seed " << seed;
    ASSERT_EQ(loop.fake->counts.advances, local.counts.advances) << "seed " << seed;
    ASSERT_EQ(loop.fake->counts.restores, local.counts.restores) << "seed " << seed;
    ASSERT_EQ(loop.fake->counts.saves, local.counts.saves) << "seed " << seed;
    for (const FaultyChannel* channel : {&loop.to_solver, &loop.to_coordinator}) {
      total.dropped += channel->counts().dropped;
      total.delayed += channel->counts().delayed;
      total.duplicated += channel->counts().duplicated;
      total.corrupted += channel->counts().corrupted;
    }
  }
  // 1000 seeds of at least 40 frames: far fewer faults than these would mean that none were made.
  EXPECT_GT(total.dropped, 1000);
  EXPECT_GT(total.delayed, 1000);
  EXPECT_GT(total.duplicated, 1000);
  EXPECT_GT(total.corrupted, 1000);
}

TEST(Transport, SurvivesTheLossOfEachSingleMessage) {
  // The n-th frame of one direction is lost, for every n until a run passes untouched.
  FakeSubdomain local;
  play(local, 3);
  for (const bool to_solver : {true, false}) {
    int lost = 0;
    for (int at = 1; lost == at - 1; ++at) {
      const FaultyChannel::Chances lose_one{.lose = at};
      Loop loop(to_solver ? lose_one : FaultyChannel::Chances{},
                to_solver ? FaultyChannel::Chances{} : lose_one);
      loop.configure();
      play(loop.body, 3);
      EXPECT_EQ(loop.body.state_hash(), local.state_hash());
      EXPECT_EQ(loop.fake->counts.advances, local.counts.advances);
      lost += loop.to_solver.counts().dropped + loop.to_coordinator.counts().dropped;
    }
    EXPECT_EQ(lost, 1 + 6 + 1);  // configure, advances, hash: each was lost once
  }
}

TEST(Transport, ASaveAndARestoreCostNoMessage) {
  ConfiguredLoop loop;
  const int before = loop.to_solver.counts().sent;
  play(loop.body, 5);
  EXPECT_EQ(loop.to_solver.counts().sent - before, 10);
  EXPECT_EQ(loop.fake->counts.saves, 5);
  EXPECT_EQ(loop.fake->counts.restores, 5);
}

TEST(Transport, APendingRestoreIsDoneBeforeTheHashIsTaken) {
  ConfiguredLoop loop;
  const std::uint64_t begin = loop.body.state_hash();
  Response response;
  const Advance advance = request_for(0);
  loop.body.save();
  EXPECT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(advance, response)));
  EXPECT_NE(loop.body.state_hash(), begin);
  loop.body.restore();
  EXPECT_EQ(loop.body.state_hash(), begin);
}

TEST(Transport, ARestoreAfterAPendingSaveKeepsThePresentState) {
  ConfiguredLoop loop;
  Response response;
  const Advance advance = request_for(0);
  loop.body.save();
  EXPECT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(advance, response)));
  const std::uint64_t present = loop.body.state_hash();
  loop.body.save();
  loop.body.restore();
  EXPECT_EQ(loop.body.state_hash(), present);
}

TEST(Transport, ACheckpointResumesInAnotherBody) {
  Loop first;
  first.configure();
  play(first.body, 2);
  Loop second;
  second.configure();
  second.body.resume(first.body.checkpoint());
  EXPECT_EQ(second.body.state_hash(), first.body.state_hash());
}

TEST(Transport, AKernelComesBackAsTheBodyMadeIt) {
  ConfiguredLoop loop;
  const std::vector<double> patterns{1.0, -2.5};
  const PortKernel got = loop.body.probe({0, patterns, 0.01, 5});
  EXPECT_EQ(got.displacement, loop.fake->probe({0, patterns, 0.01, 5}).displacement);
  EXPECT_EQ(got.patterns, 2);
  EXPECT_EQ(got.count(), 5);
}

/// It is a value of the numbers' kind, so that the coordinator may go another way, and the body
/// serves on.
TEST(Transport, ABodyWithoutAKernelSaysSoInEitherPlacement) {
  ConfiguredLoop loop;
  loop.fake->before_probe = [] {
    throw NoAnswer({Failed::Cause::inverted_element, 0.0, "an element is inverted"}, "fake");
  };
  const auto told = [](Subdomain& body) -> std::string {
    try {
      (void)body.probe({0, {1.0}, 0.01, 5});
    } catch (const NoAnswer& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(told(loop.body), told(*loop.fake));
  EXPECT_NE(told(loop.body), "nothing");
  loop.fake->before_probe = nullptr;
  EXPECT_EQ(loop.body.probe({0, {1.0}, 0.01, 5}).count(), 5);
}

}  // namespace
}  // namespace abut::at_most_once_test
