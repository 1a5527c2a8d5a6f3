#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "messaging/channel.hpp"

namespace abut {

struct FieldPath;

/// Whether a field of value 0 is left out: protobuf does, except in fields that are `optional`.
enum class Zero { left_out, told };

/// Writes Protocol Buffers from the end to the begin, so that the length of what a field holds is
/// known when it is written: arrays are copied once, from where they are into the frame.
class WireWriter {
 public:
  /// Forgets what was written. The memory is kept unless somebody still sends it.
  void clear();
  std::size_t size() const { return storage_->size() - begin_; }
  Bytes bytes() const { return Bytes(storage_->data() + begin_, size()); }
  /// As long as it is held, the bytes stay as they are.
  std::shared_ptr<const void> owner() const { return storage_; }

  /// Room before what was written.
  std::byte* space(std::size_t count);
  void integer(int field, std::int64_t value, Zero zero = Zero::left_out);
  void number(int field, double value);
  void numbers(int field, const std::vector<double>& values);
  void integers(int field, const std::vector<std::int32_t>& values);
  /// Makes a message of what was written since the size was `before`.
  void close(int field, std::size_t before);

 private:
  void varint(std::uint64_t value);
  void tag(int field, int type);

  std::shared_ptr<std::vector<std::byte>> storage_ = std::make_shared<std::vector<std::byte>>();
  std::size_t begin_ = 0;
};

/// Reads what a message holds, field by field, from the bytes in which it came. Throws CodecError
/// at bytes that are no message.
class WireReader {
 public:
  /// The path must outlive this object.
  WireReader(Bytes bytes, const FieldPath& path) : rest_(bytes), path_(path) {}
  /// Goes to the next field; false at the end. Each field is read or skipped.
  bool next();
  int field() const { return field_; }
  /// From where the field begins, its tag included.
  Bytes from_here() const { return here_; }
  Bytes rest() const { return rest_; }

  std::int64_t integer();
  double number();
  /// Appends: packed or one by one.
  void numbers(std::vector<double>& to);
  void integers(std::vector<std::int32_t>& to);
  Bytes message();
  void skip();

 private:
  std::uint64_t varint(Bytes& from) const;
  Bytes take(std::size_t count);
  void require(int type) const;

  Bytes rest_, here_;
  const FieldPath& path_;
  int field_ = 0, type_ = 0;
};

}  // namespace abut
