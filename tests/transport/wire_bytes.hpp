#pragma once

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"

namespace abut {

// What is written straight into frames, as protobuf's own classes see it: each is an independent
// reader and writer of the other's bytes.

inline Bytes as_bytes(const std::string& text) {
  return std::as_bytes(std::span<const char>(text));
}

template <class Wire, class... From>
void through_writer(Wire& to, const From&... from) {
  WireWriter out;
  encode(from..., out);
  const Bytes bytes = out.bytes();
  EXPECT_TRUE(to.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
}

inline void encode(const Advance& from, v1::Advance& to) { through_writer(to, from); }
inline void encode(const Response& from, const Advance& asked, v1::Advanced& to) {
  through_writer(to, from, asked);
}
inline void decode(const v1::Advance& from, const Description& body, const Partners& met,
                   Advance& to) {
  const std::string text = from.SerializeAsString();
  decode(as_bytes(text), body, met, to);
}
inline void decode(const v1::Advanced& from, const Description& body, const Advance& asked,
                   Response& to) {
  const std::string text = from.SerializeAsString();
  decode(as_bytes(text), body, asked, to);
}
inline void encode(const PassiveStep& from, v1::PassiveStep& to) { through_writer(to, from); }
inline void encode(const PassiveReply& from, v1::PassiveStepped& to) { through_writer(to, from); }
inline void decode(const v1::PassiveStep& from, const Description& body, PassiveStep& to) {
  const std::string text = from.SerializeAsString();
  decode(as_bytes(text), body, to);
}
inline void decode(const v1::PassiveStepped& from, const Description& body,
                   const PassiveStep& asked, PassiveReply& to) {
  const std::string text = from.SerializeAsString();
  decode(as_bytes(text), body, asked, to);
}
inline bool parse_into(v1::Request& message, Bytes payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}
inline bool parse_into(v1::Reply& message, Bytes payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace abut
