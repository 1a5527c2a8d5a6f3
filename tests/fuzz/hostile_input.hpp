#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.hpp"

// What every target shares. A target is one function, which libFuzzer calls with inputs of its own
// making (preset fuzz), and replay.cpp with those that are kept.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace abut::fuzz {

using Input = std::span<const std::byte>;

inline Input input_of(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}
inline std::string text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// What is wrong with an input is told by the two errors that users see. Anything else that is
/// thrown, and every assertion, ends the target.
template <class Act>
void read_or_refuse(const Act& act) {
  try {
    act();
  } catch (const InputError&) {
  } catch (const RunError&) {
  }
}

/// Takes the next part of an input: its length stands before it in two bytes, the lower one first;
/// the last one may be shorter.
inline Input take_part(Input& rest) {
  if (rest.size() < 2) return rest = {};
  const std::size_t length =
      std::to_integer<std::size_t>(rest[0]) + 256 * std::to_integer<std::size_t>(rest[1]);
  const Input part = rest.subspan(2, std::min(length, rest.size() - 2));
  rest = rest.subspan(2 + part.size());
  return part;
}

}  // namespace abut::fuzz
