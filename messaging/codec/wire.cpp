#include "messaging/codec/wire.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

constexpr int varint_type = 0, fixed64_type = 1, length_type = 2, fixed32_type = 5;
constexpr std::size_t longest_varint = 10;
constexpr std::size_t least_storage = 4096;

}  // namespace

void WireWriter::clear() {
  if (storage_.use_count() > 1) {  // a sender has not done with it: the transport's own thread
    storage_ = std::make_shared<std::vector<std::byte>>(storage_->size());
  }
  std::atomic_thread_fence(std::memory_order_acquire);  // what that thread read, it has read
  begin_ = storage_->size();
}

std::byte* WireWriter::space(std::size_t count) {
  if (count > begin_) {
    const std::size_t used = size();
    std::vector<std::byte> larger(std::max(least_storage, 2 * (used + count)));
    std::copy_n(storage_->data() + begin_, used, larger.data() + larger.size() - used);
    storage_->swap(larger);
    begin_ = storage_->size() - used;
  }
  begin_ -= count;
  return storage_->data() + begin_;
}

void WireWriter::varint(std::uint64_t value) {
  std::byte bytes[longest_varint];
  std::size_t count = 0;
  for (; value >= 0x80; value >>= 7) bytes[count++] = static_cast<std::byte>(value | 0x80);
  bytes[count++] = static_cast<std::byte>(value);
  std::memcpy(space(count), bytes, count);
}

void WireWriter::tag(int field, int type) { varint(index(field << 3 | type)); }

void WireWriter::integer(int field, std::int64_t value, Zero zero) {
  if (value == 0 && zero == Zero::left_out) return;
  varint(static_cast<std::uint64_t>(value));
  tag(field, varint_type);
}

void WireWriter::number(int field, double value) {
  if (std::bit_cast<std::uint64_t>(value) == 0) return;
  std::memcpy(space(sizeof value), &value, sizeof value);
  tag(field, fixed64_type);
}

void WireWriter::numbers(int field, const std::vector<double>& values) {
  if (values.empty()) return;
  const std::size_t count = values.size() * sizeof(double);
  std::memcpy(space(count), values.data(), count);
  varint(count);
  tag(field, length_type);
}

void WireWriter::integers(int field, const std::vector<std::int32_t>& values) {
  if (values.empty()) return;
  const std::size_t before = size();
  for (auto value = values.rbegin(); value != values.rend(); ++value) {
    varint(static_cast<std::uint64_t>(std::int64_t{*value}));
  }
  close(field, before);
}

void WireWriter::close(int field, std::size_t before) {
  varint(size() - before);
  tag(field, length_type);
}

std::uint64_t WireReader::varint(Bytes& from) const {
  std::uint64_t value = 0;
  const std::size_t most = std::min(from.size(), longest_varint);
  for (std::size_t i = 0; i < most; ++i) {
    const std::uint64_t byte = std::to_integer<std::uint64_t>(from[i]);
    value |= (byte & 0x7f) << (7 * i);
    if (byte >= 0x80) continue;
    from = from.subspan(i + 1);
    return value;
  }
  path_.fail("is no sound message: a number has no end");
}

Bytes WireReader::take(std::size_t count) {
  if (count > rest_.size()) path_.fail("is no sound message: it is cut short");
  const Bytes taken = rest_.first(count);
  rest_ = rest_.subspan(count);
  return taken;
}

void WireReader::require(int type) const {
  if (type_ != type) path_.fail("is no sound message: a field is of another type");
}

bool WireReader::next() {
  if (rest_.empty()) return false;
  here_ = rest_;
  const std::uint64_t key = varint(rest_);
  type_ = static_cast<int>(key & 7);
  field_ = static_cast<int>(std::min<std::uint64_t>(key >> 3, 1u << 29));
  if (field_ == 0) path_.fail("is no sound message: a field has no number");
  return true;
}

std::int64_t WireReader::integer() {
  require(varint_type);
  return static_cast<std::int64_t>(varint(rest_));
}

double WireReader::number() {
  require(fixed64_type);
  double value = 0.0;
  std::memcpy(&value, take(sizeof value).data(), sizeof value);
  return value;
}

void WireReader::numbers(std::vector<double>& to) {
  if (type_ == fixed64_type) {
    to.push_back(number());
    return;
  }
  const Bytes packed = message();
  const std::size_t count = packed.size() / sizeof(double), before = to.size();
  if (packed.size() % sizeof(double) != 0) path_.fail("is no sound message: a number is cut");
  to.resize(before + count);
  if (count > 0) std::memcpy(to.data() + before, packed.data(), packed.size());
}

void WireReader::numbers(std::vector<double>& to, bool& begun) {
  if (begun || type_ != length_type) {
    if (!begun) to.clear();
    begun = true;
    return numbers(to);
  }
  begun = true;
  const Bytes packed = message();
  if (packed.size() % sizeof(double) != 0) path_.fail("is no sound message: a number is cut");
  to.resize(packed.size() / sizeof(double));
  if (!to.empty()) std::memcpy(to.data(), packed.data(), packed.size());
}

void WireReader::integers(std::vector<std::int32_t>& to) {
  if (type_ == varint_type) {
    to.push_back(static_cast<std::int32_t>(integer()));
    return;
  }
  Bytes packed = message();
  while (!packed.empty()) to.push_back(static_cast<std::int32_t>(varint(packed)));
}

Bytes WireReader::message() {
  require(length_type);
  const std::uint64_t count = varint(rest_);
  return take(static_cast<std::size_t>(count));
}

void WireReader::skip() {
  if (type_ == varint_type) {
    varint(rest_);
  } else if (type_ == fixed64_type) {
    take(8);
  } else if (type_ == fixed32_type) {
    take(4);
  } else {
    message();
  }
}

}  // namespace abut
