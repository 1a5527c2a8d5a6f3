#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/archive.hpp"

namespace abut {

// What every body does with its one list of changing members, `state.state(Archive&)`.

/// Keeps a state in a buffer that is used again and again.
template <class State>
void save_state(State& state, std::vector<std::byte>& kept) {
  Archive archive = Archive::writer(kept, Archive::Form::bare);
  state.state(archive);
  archive.finish();
}

/// Returns to it, bit for bit.
template <class State>
void restore_state(State& state, const std::vector<std::byte>& kept) {
  Archive archive = Archive::reader(kept, Archive::Form::bare);
  state.state(archive);
}

/// The durable form, with the names of its fields.
template <class State>
std::vector<std::byte> checkpoint_of(State& state) {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::named);
  state.state(archive);
  return bytes;
}

/// Reads it back. Throws RunError when the fields are others.
template <class State>
void read_checkpoint(State& state, std::span<const std::byte> bytes) {
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  state.state(archive);
  archive.finish();
}

}  // namespace abut
