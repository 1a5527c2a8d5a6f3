// Goal: the memory that peers and strangers can make the coordinator hold is bounded, and what is
// dropped for it costs a known peer nothing but time. Oracle: the frames that come out, by size.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "messaging/zmq_channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace abut::hub_test {
namespace {

// [B] far above a Hello, below the limit of a frame
constexpr std::size_t large = 8'000'000;
constexpr std::size_t flood = 128'000'000;  // takes longer to come than a thread to look

std::vector<std::byte> frame_of(std::size_t bytes) {
  return std::vector<std::byte>(bytes, std::byte{7});
}

std::unique_ptr<ZmqDealer> dealer(const std::string& endpoint, const std::string& name) {
  return std::make_unique<ZmqDealer>(endpoint, name, Limits{});
}

/// Reads the hub until something is so, at most `seconds`.
bool comes(ZmqHub& hub, double seconds, const std::function<bool()>& so) {
  const TimePoint until =
      std::chrono::steady_clock::now() + Milliseconds(static_cast<int>(1000.0 * seconds));
  while (!so()) {
    if (std::chrono::steady_clock::now() >= until) return false;
    hub.pump(Milliseconds(20));
  }
  return true;
}

bool hears(ZmqHub& hub, int peer, std::size_t bytes) {
  if (!comes(hub, 5.0, [&] { return hub.has_frame(peer); })) return false;
  const std::optional<Bytes> frame = hub.channel(peer).receive(Milliseconds(0));
  return frame && frame->size() == bytes;
}

TEST(Hub, OfConnectionsThatNobodyKnowsNoLongFrameComes) {
  ZmqHub hub{Limits{}};
  const int peer = hub.add_peer("peer");
  const std::string endpoint = hub.bind("tcp://127.0.0.1:*");
  const auto stranger = dealer(endpoint, "stranger"), other = dealer(endpoint, "other"),
             own = dealer(endpoint, "peer");
  stranger->send(frame_of(1000));
  std::optional<std::pair<std::string, std::vector<std::byte>>> came;
  ASSERT_TRUE(comes(hub, 5.0, [&] { return (came = hub.take_stranger()).has_value(); }));
  EXPECT_EQ(came->first, "stranger");
  EXPECT_EQ(came->second.size(), 1000u);
  // One that has said something short is no better known than one that has not.
  stranger->send(frame_of(flood));
  other->send(frame_of(flood));
  EXPECT_FALSE(comes(hub, 1.0, [&] { return hub.take_stranger().has_value(); }));
  // Whose name is known may send what it likes once it has said anything.
  own->send(frame_of(1000));
  EXPECT_TRUE(hears(hub, peer, 1000));
  own->send(frame_of(large));
  EXPECT_TRUE(hears(hub, peer, large));
}

TEST(Hub, APeerThatComesBackMayBeginWithALongFrame) {
  ZmqHub hub{Limits{}};
  const int peer = hub.add_peer("peer");
  const std::string endpoint = hub.bind("tcp://127.0.0.1:*");
  for (int round = 0; round < 3; ++round) {
    const auto here = dealer(endpoint, "peer");
    here->send(frame_of(round == 0 ? 1000 : large));
    ASSERT_TRUE(hears(hub, peer, round == 0 ? 1000 : large)) << round;
    here->send(frame_of(large));
    ASSERT_TRUE(hears(hub, peer, large)) << round;
  }
}

TEST(Hub, WhatWaitsOfAllPeersTogetherIsBounded) {
  Limits limits;
  limits.frame_bytes = 1'000'000;
  const std::size_t each = 900'000, most = 4 * limits.frame_bytes / each;
  ZmqHub hub(limits);
  constexpr int peers = 8;
  for (int p = 0; p < peers; ++p) hub.add_peer("peer" + std::to_string(p));
  const std::string endpoint = hub.bind("tcp://127.0.0.1:*");
  std::vector<std::unique_ptr<ZmqDealer>> all;
  for (int p = 0; p < peers; ++p) {
    all.push_back(dealer(endpoint, "peer" + std::to_string(p)));
    all.back()->send(frame_of(100));
    ASSERT_TRUE(hears(hub, p, 100));
  }
  for (int round = 0; round < 2; ++round) {  // what is taken makes room again
    for (const auto& one : all)
      for (int k = 0; k < 3; ++k) one->send(frame_of(each));
    while (hub.pump(Milliseconds(500))) {
    }
    std::size_t kept = 0;
    for (int p = 0; p < peers; ++p)
      for (; hub.has_frame(p); ++kept) hub.channel(p).receive(Milliseconds(0));
    EXPECT_EQ(kept, most) << round;
  }
}

}  // namespace
}  // namespace abut::hub_test
