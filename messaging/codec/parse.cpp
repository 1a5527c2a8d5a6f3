#include <google/protobuf/io/coded_stream.h>

#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

bool merge(google::protobuf::MessageLite& message, Bytes payload) {
  google::protobuf::io::CodedInputStream stream(
      reinterpret_cast<const std::uint8_t*>(payload.data()), static_cast<int>(payload.size()));
  return message.MergePartialFromCodedStream(&stream) && stream.ConsumedEntireMessage();
}

// Kinds whose arrays stay where they are, by the number of their field, which a case of the oneof
// is as well.

bool is_bulk(const v1::Request&, int field) {
  return field == v1::Request::kAdvance || field == v1::Request::kPassiveStep;
}
bool is_bulk(const v1::Reply&, int field) {
  return field == v1::Reply::kAdvanced || field == v1::Reply::kPassiveStepped;
}

void mark_kind(v1::Request& message, v1::Request::BodyCase kind) {
  if (kind == v1::Request::kAdvance) message.mutable_advance();
  if (kind == v1::Request::kPassiveStep) message.mutable_passive_step();
}
void mark_kind(v1::Reply& message, v1::Reply::BodyCase kind) {
  if (kind == v1::Reply::kAdvanced) message.mutable_advanced();
  if (kind == v1::Reply::kPassiveStepped) message.mutable_passive_stepped();
}

void clear_beside_body(v1::Request& message) {
  message.set_number(0);
  message.set_session(0);
  message.set_restore_first(false);
  message.set_save_first(false);
}
void clear_beside_body(v1::Reply& message) {
  message.set_number(0);
  message.set_session(0);
}

/// All fields but those of a bulk kind, the last of which stays where it is and is told by `kind`.
template <class Message>
bool parse_around(Message& message, Bytes payload, Bytes& bulk, typename Message::BodyCase& kind) {
  const FieldPath path{nullptr, "message"};
  try {
    for (WireReader from(payload, path); from.next();) {
      const Bytes here = from.from_here();
      if (is_bulk(message, from.field())) {
        bulk = from.message();
        kind = static_cast<typename Message::BodyCase>(from.field());
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

// Clear() of a oneof would free what it holds; the mark of a kind that comes again and again stays.
template <class Message>
bool parse(Message& message, Bytes payload, Bytes& bulk) {
  if (is_bulk(message, message.body_case())) {
    clear_beside_body(message);
  } else {
    message.Clear();
  }
  typename Message::BodyCase kind = Message::BODY_NOT_SET;
  bulk = {};
  if (!parse_around(message, payload, bulk, kind)) return false;
  if (is_bulk(message, kind)) {
    mark_kind(message, kind);
  } else if (is_bulk(message, message.body_case())) {
    message.clear_body();
  }
  return true;
}

}  // namespace

bool parse_into(v1::Request& message, Bytes payload, Bytes& bulk) {
  return parse(message, payload, bulk);
}

bool parse_into(v1::Reply& message, Bytes payload, Bytes& bulk) {
  return parse(message, payload, bulk);
}

}  // namespace abut
