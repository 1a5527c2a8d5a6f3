#include "messaging/codec_parts.hpp"
#include "base/index.hpp"

#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>

#include <bit>
#include <cmath>

namespace abut {

namespace {

constexpr int most_width = 1 << 24;  // points x dimension of one port

/// Looks at exponents, because comparing each number would keep the loop from running at full
/// speed.
bool all_finite(const double* values, std::size_t count) {
  constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
  std::uint64_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bad |= (std::bit_cast<std::uint64_t>(values[i]) & exponent) == exponent;
  }
  return bad == 0;
}

bool merge(google::protobuf::MessageLite& message, Bytes payload) {
  google::protobuf::io::CodedInputStream stream(
      reinterpret_cast<const std::uint8_t*>(payload.data()), static_cast<int>(payload.size()));
  return message.MergeFromCodedStream(&stream) && stream.ConsumedEntireMessage();
}

}  // namespace

std::string FieldPath::text() const {
  std::string text = parent != nullptr ? parent->text() : std::string();
  if (!text.empty()) text += '.';
  text += name;
  if (index >= 0) text += fmt::format("[{}]", index);
  return text;
}

void FieldPath::fail(const std::string& why) const { throw CodecError(text() + ' ' + why); }

// Clear() of a oneof would free what it holds. When the case is likely to come again, only the
// inside is cleared and the new message merged into it; required parts (steps, window) tell an
// empty message apart.
bool parse_into(v1::Request& message, Bytes payload) {
  if (message.has_advance()) {
    message.mutable_advance()->Clear();
    message.set_number(0);
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
  } else {
    message.Clear();
  }
  return merge(message, payload);
}

void take(const google::protobuf::RepeatedField<double>& from, const FieldPath& path,
          std::vector<double>& to) {
  const std::size_t count = index(from.size());
  if (!all_finite(from.data(), count)) {
    int first = 0;
    while (std::isfinite(from.Get(first))) ++first;
    path.fail(fmt::format("is not finite: entry {} is {}", first, from.Get(first)));
  }
  to.assign(from.data(), from.data() + count);
}

void take(const google::protobuf::RepeatedField<double>& from, std::size_t expected,
          bool may_be_empty, const FieldPath& path, std::vector<double>& to) {
  const std::size_t count = index(from.size());
  if (count != expected && !(may_be_empty && count == 0)) {
    path.fail(fmt::format("has {} numbers where {} belong", count, expected));
  }
  take(from, path, to);
}

double number(double value, const FieldPath& path, Allow allow) {
  const bool good = allow == Allow::finite ? std::isfinite(value) : !std::isnan(value);
  if (!good) path.fail(fmt::format("is not finite: {}", value));
  return value;
}

v1::ForceSupport encode(ForceSupport support) {
  return support == ForceSupport::nodal ? v1::FORCE_SUPPORT_NODAL : v1::FORCE_SUPPORT_STEP;
}

ForceSupport decode(v1::ForceSupport support, const FieldPath& path) {
  if (support == v1::FORCE_SUPPORT_NODAL) return ForceSupport::nodal;
  if (support == v1::FORCE_SUPPORT_STEP) return ForceSupport::step;
  path.fail(fmt::format("has an unknown value {}", static_cast<int>(support)));
}

void encode(const Waveform& from, v1::Waveform& to) {
  to.set_width(from.width);
  to.set_support(encode(from.support));
  copy(from.time, *to.mutable_time());
  copy(from.u, *to.mutable_u());
  copy(from.v, *to.mutable_v());
  copy(from.a, *to.mutable_a());
  copy(from.f, *to.mutable_f());
}

void decode(const v1::Waveform& from, const FieldPath& path, Waveform& to) {
  if (from.width() < 1 || from.width() > most_width) {
    FieldPath{&path, "width"}.fail(fmt::format("is {}, not 1 to {}", from.width(), most_width));
  }
  to.width = from.width();
  to.support = decode(from.support(), FieldPath{&path, "support"});
  take(from.time(), FieldPath{&path, "time"}, to.time);
  for (std::size_t i = 1; i < to.time.size(); ++i) {
    if (to.time[i] > to.time[i - 1]) continue;
    FieldPath{&path, "time"}.fail(fmt::format("does not increase at entry {}", i));
  }
  const std::size_t count = to.time.size() * index(to.width);
  take(from.u(), count, true, FieldPath{&path, "u"}, to.u);
  take(from.v(), count, true, FieldPath{&path, "v"}, to.v);
  take(from.a(), count, true, FieldPath{&path, "a"}, to.a);
  take(from.f(), count, true, FieldPath{&path, "f"}, to.f);
}

}  // namespace abut
