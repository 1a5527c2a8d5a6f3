#include <google/protobuf/io/coded_stream.h>

#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

bool merge(google::protobuf::MessageLite& message, Bytes payload) {
  google::protobuf::io::CodedInputStream stream(
      reinterpret_cast<const std::uint8_t*>(payload.data()), static_cast<int>(payload.size()));
  return message.MergePartialFromCodedStream(&stream) && stream.ConsumedEntireMessage();
}

/// All fields but one, which stays where it is; whether it was there.
bool parse_around(google::protobuf::MessageLite& message, Bytes payload, int field, Bytes& bulk,
                  bool& there) {
  const FieldPath path{nullptr, "message"};
  try {
    for (WireReader from(payload, path); from.next();) {
      const Bytes here = from.from_here();
      if (from.field() == field) {
        bulk = from.message();
        there = true;
        continue;
      }
      from.skip();
      if (!merge(message, here.first(here.size() - from.rest().size()))) return false;
    }
  } catch (const CodecError&) {
    return false;
  }
  return true;
}

}  // namespace

// Clear() of a oneof would free what it holds; the mark of a kind that comes again and again stays.
bool parse_into(v1::Request& message, Bytes payload, Bytes& bulk) {
  if (message.has_advance()) {
    message.set_number(0);
    message.set_session(0);
    message.set_restore_first(false);
    message.set_save_first(false);
  } else {
    message.Clear();
  }
  bool there = false;
  bulk = {};
  if (!parse_around(message, payload, v1::Request::kAdvanceFieldNumber, bulk, there)) return false;
  if (there) {
    message.mutable_advance();
  } else if (message.has_advance()) {
    message.clear_body();
  }
  return true;
}

bool parse_into(v1::Reply& message, Bytes payload, Bytes& bulk) {
  if (message.has_advanced()) {
    message.set_number(0);
    message.set_session(0);
  } else {
    message.Clear();
  }
  bool there = false;
  bulk = {};
  if (!parse_around(message, payload, v1::Reply::kAdvancedFieldNumber, bulk, there)) return false;
  if (there) {
    message.mutable_advanced();
  } else if (message.has_advanced()) {
    message.clear_body();
  }
  return true;
}

}  // namespace abut
