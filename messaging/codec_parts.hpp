#pragma once

#include <google/protobuf/repeated_field.h>

#include <cstdint>
#include <string>
#include <vector>

#include "messaging/codec.hpp"

namespace abut {

/// The way to a field, as a chain on the stack: text is made of it only when the field is wrong.
struct FieldPath {
  const FieldPath* parent = nullptr;
  const char* name = "";
  int index = -1;  // in a repeated field

  std::string text() const;
  [[noreturn]] void fail(const std::string& why) const;
};

/// Which numbers a field may hold.
enum class Allow { finite, infinite };

inline void copy(const std::vector<double>& from, google::protobuf::RepeatedField<double>& to) {
  to.Clear();
  to.Add(from.data(), from.data() + from.size());
}

/// Copies and checks that all are finite.
void take(const google::protobuf::RepeatedField<double>& from, const FieldPath& path,
          std::vector<double>& to);
/// The same, and the count is `expected`, or 0 where `may_be_empty`.
void take(const google::protobuf::RepeatedField<double>& from, std::size_t expected,
          bool may_be_empty, const FieldPath& path, std::vector<double>& to);
double number(double value, const FieldPath& path, Allow allow = Allow::finite);

void encode(const Waveform& from, v1::Waveform& to);
void decode(const v1::Waveform& from, const FieldPath& path, Waveform& to);
v1::ForceSupport encode(ForceSupport support);
ForceSupport decode(v1::ForceSupport support, const FieldPath& path);

/// Description::fields alone.
void encode(const std::vector<FieldInfo>& from, v1::Description& to);
void decode(const v1::Description& from, const FieldPath& path, std::vector<FieldInfo>& to);

}  // namespace abut
