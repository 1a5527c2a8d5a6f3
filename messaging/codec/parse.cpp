#include <google/protobuf/io/coded_stream.h>

#include "messaging/codec.hpp"

namespace abut {

namespace {

bool merge(google::protobuf::MessageLite& message, Bytes payload) {
  google::protobuf::io::CodedInputStream stream(
      reinterpret_cast<const std::uint8_t*>(payload.data()), static_cast<int>(payload.size()));
  return message.MergeFromCodedStream(&stream) && stream.ConsumedEntireMessage();
}

}  // namespace

// Clear() of a oneof would free what it holds. When the case is likely to come again, only the
// inside is cleared and the new message merged into it; required parts (steps, window) tell an
// empty message apart.
bool parse_into(v1::Request& message, Bytes payload) {
  if (message.has_advance()) {
    message.mutable_advance()->Clear();
    message.set_number(0);
    message.set_session(0);
    message.set_restore_first(false);
    message.set_save_first(false);
  } else {
    message.Clear();
  }
  return merge(message, payload);
}

bool parse_into(v1::Reply& message, Bytes payload) {
  if (message.has_advanced()) {
    message.mutable_advanced()->Clear();
    message.set_number(0);
    message.set_session(0);
  } else {
    message.Clear();
  }
  return merge(message, payload);
}

}  // namespace abut
