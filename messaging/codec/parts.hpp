#pragma once

#include <google/protobuf/repeated_field.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"

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
enum class Allow {
  finite,
  infinite,            // any but NaN
  not_negative,        // and finite
  not_negative_or_inf  // and not NaN
};

inline constexpr int most_ports = 4096;
inline constexpr std::size_t most_partners = 65'536;  // of one port
inline constexpr int most_names = 4096;               // members, measures, columns
inline constexpr int most_width = 1 << 24;            // points x dimension of one surface

template <class T>
void copy(const std::vector<T>& from, google::protobuf::RepeatedField<T>& to) {
  to.Clear();
  to.Add(from.data(), from.data() + from.size());
}

/// Sizes a repeated message and keeps the memory of the entries.
template <class T>
void resize(google::protobuf::RepeatedPtrField<T>& field, std::size_t count) {
  while (field.size() > static_cast<int>(count)) field.RemoveLast();
  while (field.size() < static_cast<int>(count)) field.Add();
}

/// Copies and checks that all are finite.
void take(const google::protobuf::RepeatedField<double>& from, const FieldPath& path,
          std::vector<double>& to);
/// The same, and the count is `expected`, or 0 where `may_be_empty`.
void take(const google::protobuf::RepeatedField<double>& from, std::size_t expected,
          bool may_be_empty, const FieldPath& path, std::vector<double>& to);
/// The same of values that are where they belong.
void check(const std::vector<double>& values, std::size_t expected, bool may_be_empty,
           const FieldPath& path);
/// Points of a surface of so many ascend; empty: all of them.
void check_points(const std::vector<std::int32_t>& points, int count, const FieldPath& path);
void take_names(const google::protobuf::RepeatedPtrField<std::string>& from, const FieldPath& path,
                std::vector<std::string>& to);
double number(double value, const FieldPath& path, Allow allow = Allow::finite);
/// A number from 0 that is less than `count`.
int position(int value, std::size_t count, const FieldPath& path);
int dimension(int dim, const FieldPath& path);
void require_count(std::size_t count, std::size_t expected, const char* of, const FieldPath& path);

v1::ForceSupport encode(ForceSupport support);
ForceSupport decode(v1::ForceSupport support, const FieldPath& path);

/// The fields that are wanted, as a field of the message that is being written.
void encode(const Waveform& from, const Want& want, int field, WireWriter& to);
/// Of the surface's points, or of those that it lists.
void decode(Bytes from, const SurfaceSize& surface, const FieldPath& path, Waveform& to);
/// Entries of substeps x points ascend from 0, and are below `most`.
void check_slid(const std::vector<std::int32_t>& slid, std::int64_t most, const FieldPath& path);
/// A field of a waveform that this message is for is there.
void require_field(const Waveform& of, const std::vector<double>& field, const char* name,
                   const FieldPath& path);

void encode(const PortGeometry& from, v1::Surface& to);
void decode(const v1::Surface& from, const FieldPath& path, PortGeometry& to);

/// The arrays are whole and of one size; patterns and width are those that the caller expects.
void decode(const v1::PortKernel& from, int patterns, int width, int dim, const FieldPath& path,
            PortKernel& to);

void encode(const BoundaryData& from, WireWriter& to);
void decode(Bytes from, const SurfaceSize& port, const std::vector<SurfaceSize>& partners,
            const FieldPath& path, BoundaryData& to);

void encode(const BodyRecord& from, WireWriter& to);
void decode(Bytes from, const Description& body, const FieldPath& path, BodyRecord& to);

/// Description::fields alone.
void encode(const std::vector<FieldInfo>& from, v1::Description& to);
void decode(const v1::Description& from, const FieldPath& path, std::vector<FieldInfo>& to);

}  // namespace abut
