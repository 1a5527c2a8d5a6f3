#include "base/archive.hpp"

// The same sums by the widest vector registers that the machine has, where the library can choose.
#if defined(__x86_64__) && __has_include(<xxh_x86dispatch.h>)
#define ABUT_WIDE_SUMS
#include <xxh_x86dispatch.h>
#else
#include <xxhash.h>
#endif

#include <cstring>

#include "base/error.hpp"

namespace abut {
namespace {

const char* type_name(char type) {
  switch (type) {
    case 'd':
      return "number";
    case 'i':
      return "integer";
    case 'b':
      return "truth value";
    case 'v':
      return "list of numbers";
    case 's':
      return "text";
    default:
      return "unknown type";
  }
}

/// One large memcpy becomes a string move instruction, which some processors run 15 times slower
/// when the two addresses differ by a few bytes; pieces of this size are copied by vector
/// registers.
void copy_bytes(void* to, const void* from, std::size_t size) {
  constexpr std::size_t piece = 1024;
  std::byte* target = static_cast<std::byte*>(to);
  const std::byte* source = static_cast<const std::byte*>(from);
  for (; size > piece; size -= piece, target += piece, source += piece) {
    std::memcpy(target, source, piece);
  }
  std::memcpy(target, source, size);
}

}  // namespace

Archive Archive::writer(std::vector<std::byte>& out, Form form) {
  Archive archive(Mode::write, form);
  archive.out_ = &out;
  return archive;
}

Archive Archive::reader(std::span<const std::byte> in, Form form) {
  Archive archive(Mode::read, form);
  archive.in_ = in;
  return archive;
}

void Archive::field(std::string_view name, double& value) {
  scalar(name, 'd', &value, sizeof value);
}

void Archive::field(std::string_view name, std::int64_t& value) {
  scalar(name, 'i', &value, sizeof value);
}

void Archive::field(std::string_view name, bool& value) {
  std::uint8_t byte = value ? 1 : 0;
  scalar(name, 'b', &byte, sizeof byte);
  if (byte > 1) fail(name, "holds neither true nor false");
  value = byte == 1;
}

void Archive::field(std::string_view name, std::vector<double>& values) {
  label(name, 'v');
  std::uint64_t count = values.size();
  raw(&count, sizeof count);
  if (mode_ == Mode::read) {
    if (count > (in_.size() - at_) / sizeof(double)) fail(name, "is longer than the archive");
    values.resize(count);
  }
  raw(values.data(), count * sizeof(double));
}

void Archive::field(std::string_view name, std::string& text) {
  label(name, 's');
  std::uint64_t count = text.size();
  raw(&count, sizeof count);
  if (mode_ == Mode::read) {
    if (count > in_.size() - at_) fail(name, "is longer than the archive");
    text.resize(count);
  }
  raw(text.data(), count);
}

void Archive::check_count(std::string_view name, std::int64_t count) const {
  if (writing()) return;
  if (count < 0 || static_cast<std::uint64_t>(count) > in_.size() - at_)
    fail(name, "is longer than the archive");
}

void Archive::finish() {
  if (mode_ == Mode::write) out_->resize(at_);
  if (mode_ == Mode::read && at_ != in_.size())
    throw RunError("has " + std::to_string(in_.size() - at_) + " bytes after the last field",
                   "saved state", "It belongs to another version of this body; start afresh.");
}

void Archive::scalar(std::string_view name, char type, void* data, std::size_t size) {
  label(name, type);
  if (mode_ == Mode::read && in_.size() - at_ < size) fail(name, "is cut off");
  raw(data, size);
}

/// In named form writes the field's name and type, or reads and compares them.
void Archive::label(std::string_view name, char type) {
  if (form_ == Form::bare) return;
  std::uint16_t length = static_cast<std::uint16_t>(name.size());
  if (mode_ == Mode::write) {
    std::string copy(name);
    raw(&length, sizeof length);
    raw(copy.data(), length);
    raw(&type, sizeof type);
    return;
  }
  if (at_ == in_.size()) fail(name, "is missing");
  raw(&length, sizeof length);
  if (length > in_.size() - at_) fail(name, "is cut off");
  std::string found(length, '\0');
  raw(found.data(), length);
  if (found != name) fail(name, "is expected, but the archive holds " + found);
  char found_type = 0;
  raw(&found_type, sizeof found_type);
  if (found_type != type)
    fail(name, std::string("is expected to be of type ") + type_name(type) +
                   ", but the archive holds " + type_name(found_type));
}

void Archive::raw(void* data, std::size_t size) {
  if (size == 0) return;
  if (mode_ == Mode::write) {
    if (at_ + size > out_->size()) out_->resize(at_ + size);
    copy_bytes(out_->data() + at_, data, size);
  } else {
    if (size > in_.size() - at_) fail("field", "is cut off");
    copy_bytes(data, in_.data() + at_, size);
  }
  at_ += size;
}

void Archive::fail(std::string_view name, const std::string& why) const {
  throw RunError(std::string(name) + ' ' + why, "saved state",
                 "It belongs to another version of this body; start afresh.");
}

namespace {

/// The library leaves the upper halves of wide registers in use, and every later instruction of the
/// narrow kind waits for them: runs in processes took up to three times as long.
#ifdef ABUT_WIDE_SUMS
[[gnu::target("avx")]] void zero_upper_halves() { __builtin_ia32_vzeroupper(); }

void release_wide_registers() {
  if (__builtin_cpu_supports("avx")) zero_upper_halves();
}
#else
void release_wide_registers() {}
#endif

}  // namespace

std::uint64_t hash_bytes(std::span<const std::byte> bytes) {
  const std::uint64_t sum = XXH3_64bits(bytes.data(), bytes.size());
  release_wide_registers();
  return sum;
}

std::uint64_t hash_combine(std::uint64_t seed, std::uint64_t value) {
  return XXH3_64bits_withSeed(&value, sizeof value, seed);
}

}  // namespace abut
