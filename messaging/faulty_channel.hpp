#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "messaging/channel.hpp"

namespace abut {

/// Wraps a channel and mistreats what is sent through it; the same seed gives the same faults.
class FaultyChannel : public Channel {
 public:
  /// Chances per frame, each between 0 and 1.
  struct Chances {
    double drop = 0.0;
    double delay = 0.0;  // behind up to `longest_delay` later calls: frames overtake each other
    double duplicate = 0.0;
    double corrupt = 0.0;  // one bit is flipped, or the tail is cut off
    int lose = 0;          // the frame of this number, counted from 1, is dropped; 0: none
  };
  struct Counts {
    int sent = 0, dropped = 0, delayed = 0, duplicated = 0, corrupted = 0;
  };

  FaultyChannel(Channel& inner, const Chances& chances, std::uint64_t seed);
  using Channel::send;
  bool send(Bytes frame) override;
  std::optional<Bytes> receive(Milliseconds wait) override;
  TimePoint now() const override { return inner_.now(); }

  Counts counts() const { return counts_; }

 private:
  static constexpr int longest_delay = 6;  // [calls]
  bool happens(double chance);
  std::vector<std::byte> damaged(Bytes frame);
  void release_due();

  Channel& inner_;
  Chances chances_;
  Counts counts_;
  std::mt19937_64 random_;
  std::vector<std::pair<int, std::vector<std::byte>>> held_;  // calls left, frame
};

}  // namespace abut
