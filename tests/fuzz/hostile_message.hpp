#pragma once

#include <cstdint>
#include <cstring>
#include <optional>

#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"
#include "messaging/frame.hpp"
#include "messaging/soundness.hpp"

namespace abut::fuzz {

/// Seals the payload, whatever it holds, with this number and session behind it: of a field that a
/// message has twice, the last one counts. `Message`: v1::Request or v1::Reply.
template <class Message>
Bytes seal(Frame& frame, Bytes payload, std::uint64_t number, std::uint64_t session) {
  WireWriter& out = frame.open();
  out.integer(Message::kSessionFieldNumber, static_cast<std::int64_t>(session));
  out.integer(Message::kNumberFieldNumber, static_cast<std::int64_t>(number));
  std::byte* place = out.space(payload.size());
  if (!payload.empty()) std::memcpy(place, payload.data(), payload.size());
  frame.seal();
  return frame.bytes();
}

/// What a Configured tells of a body; nothing: it is no sound one.
inline std::optional<Description> described(Bytes payload) {
  v1::Reply reply;
  Bytes bulk;
  if (!parse_into(reply, payload, bulk) || !reply.has_configured()) return std::nullopt;
  try {
    Description description;
    decode(reply.configured().description(), description);
    require_sound(description);
    return description;
  } catch (const CodecError&) {
    return std::nullopt;
  }
}

}  // namespace abut::fuzz
