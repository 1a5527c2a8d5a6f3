#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace abut {

/// One visitor over a class's changing members: writes them to bytes or reads them back.
///
/// A class names each member that changes during a step once, in `void state(Archive&)`; rewind,
/// checkpoint, hash and replay all read that list. In named form every field carries name, type and
/// count, so that a stale checkpoint says which field changed; the bare form holds the numbers and
/// the lengths of lists alone (rewind, hash). Bytes are in the machine's own order.
class Archive {
 public:
  enum class Mode { write, read };
  enum class Form { bare, named };

  /// Writes over what `out` holds, which grows as needed: a buffer used again costs no allocation.
  static Archive writer(std::vector<std::byte>& out, Form form);
  static Archive reader(std::span<const std::byte> in, Form form);

  bool writing() const { return mode_ == Mode::write; }
  /// Makes sure, when reading, that a list of so many items can be held by what is left.
  void check_count(std::string_view name, std::int64_t count) const;

  void field(std::string_view name, double& value);
  void field(std::string_view name, std::int64_t& value);
  void field(std::string_view name, bool& value);
  void field(std::string_view name, std::vector<double>& values);
  void field(std::string_view name, std::string& text);

  /// Cuts what a longer earlier writing left behind. Throws RunError when a read has left bytes
  /// behind: the archive belongs to another state.
  void finish();
  /// Of what is left to read nothing is of use.
  void leave_rest() { at_ = in_.size(); }

 private:
  Archive(Mode mode, Form form) : mode_(mode), form_(form) {}
  void scalar(std::string_view name, char type, void* data, std::size_t size);
  void label(std::string_view name, char type);
  void raw(void* data, std::size_t size);
  [[noreturn]] void fail(std::string_view name, const std::string& why) const;

  Mode mode_;
  Form form_;
  std::vector<std::byte>* out_ = nullptr;
  std::span<const std::byte> in_;
  std::size_t at_ = 0;
};

/// 64-bit hash of bytes (XXH3), the same on every machine of one byte order.
std::uint64_t hash_bytes(std::span<const std::byte> bytes);
/// Folds a value into a running hash.
std::uint64_t hash_combine(std::uint64_t seed, std::uint64_t value);

/// State hash of anything with `state(Archive&)`.
template <class T>
std::uint64_t hash_state(T& object) {
  std::vector<std::byte> buffer;
  Archive archive = Archive::writer(buffer, Archive::Form::bare);
  object.state(archive);
  return hash_bytes(buffer);
}

}  // namespace abut
