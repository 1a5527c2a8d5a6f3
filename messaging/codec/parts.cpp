#include "messaging/codec/parts.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

/// Products and squares of numbers below this, summed up, stay finite: 2^499, about 1.6e150. What
/// is larger is no motion and no force of anything.
constexpr double too_large = 0x1.0p499;

bool sound(double value) { return std::abs(value) < too_large; }  // false of NaN

/// An exponent from that of `too_large` on, `more` added to it, carries into the sign's place.
/// Comparing each number would keep the loop from running at full speed.
bool all_sound(const double* values, std::size_t count) {
  constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
  constexpr std::uint64_t more =
      0x8000'0000'0000'0000 - (std::bit_cast<std::uint64_t>(too_large) & exponent);
  std::uint64_t carried = 0;
  for (std::size_t i = 0; i < count; ++i)
    carried |= (std::bit_cast<std::uint64_t>(values[i]) & exponent) + more;
  return carried >> 63 == 0;
}

const char* what_is_wrong(double value) {
  return std::isfinite(value) ? "is too large" : "is not finite";
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

void check(const std::vector<double>& values, std::size_t expected, bool may_be_empty,
           const FieldPath& path) {
  const std::size_t count = values.size();
  if (count != expected && !(may_be_empty && count == 0)) {
    path.fail(fmt::format("has {} numbers where {} belong", count, expected));
  }
  if (all_sound(values.data(), count)) return;
  std::size_t first = 0;
  while (sound(values[first])) ++first;
  path.fail(
      fmt::format("{}: entry {} is {}", what_is_wrong(values[first]), first, values[first]));
}

void take(const google::protobuf::RepeatedField<double>& from, std::size_t expected,
          bool may_be_empty, const FieldPath& path, std::vector<double>& to) {
  to.assign(from.begin(), from.end());
  check(to, expected, may_be_empty, path);
}

void take(const google::protobuf::RepeatedField<double>& from, const FieldPath& path,
          std::vector<double>& to) {
  take(from, index(from.size()), true, path, to);
}

void check_points(const std::vector<std::int32_t>& points, int count, const FieldPath& path) {
  std::int32_t least = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] < 0 || points[i] >= count) {
      path.fail(fmt::format("names point {}, but the surface has {}", points[i], count));
    }
    if (points[i] < least) path.fail(fmt::format("does not ascend at entry {}", i));
    least = points[i] + 1;
  }
}

void check_slid(const std::vector<std::int32_t>& slid, std::int64_t most, const FieldPath& path) {
  std::int32_t least = 0;
  for (std::size_t i = 0; i < slid.size(); ++i) {
    if (slid[i] < least) path.fail(fmt::format("does not ascend at entry {}", i));
    if (slid[i] >= most)
      path.fail(fmt::format("has entry {}, but {} are all of substeps and points", slid[i], most));
    least = slid[i] + 1;
  }
}

void take_names(const google::protobuf::RepeatedPtrField<std::string>& from, const FieldPath& path,
                std::vector<std::string>& to) {
  if (from.size() > most_names) path.fail("has too many entries");
  to.assign(from.begin(), from.end());
}

double number(double value, const FieldPath& path, Allow allow) {
  const bool may_be_infinite = allow == Allow::infinite || allow == Allow::not_negative_or_inf;
  if (!sound(value) && !(may_be_infinite && std::isinf(value)))
    path.fail(fmt::format("{}: {}", what_is_wrong(value), value));
  const bool any_sign = allow == Allow::finite || allow == Allow::infinite;
  if (!any_sign && value < 0.0) path.fail(fmt::format("is negative: {}", value));
  return value;
}

int position(int value, std::size_t count, const FieldPath& path) {
  if (value < 0 || index(value) >= count) {
    path.fail(fmt::format("is {}, but there are {}", value, count));
  }
  return value;
}

int dimension(int dim, const FieldPath& path) {
  if (dim < 1 || dim > 3) path.fail(fmt::format("is {}, not 1, 2 or 3", dim));
  return dim;
}

void require_count(std::size_t count, std::size_t expected, const char* of, const FieldPath& path) {
  if (count == expected) return;
  path.fail(fmt::format("has {} entries for {} {}", count, expected, of));
}

v1::ForceSupport encode(ForceSupport support) {
  if (support == ForceSupport::linear) return v1::FORCE_SUPPORT_LINEAR;
  return support == ForceSupport::nodal ? v1::FORCE_SUPPORT_NODAL : v1::FORCE_SUPPORT_STEP;
}

ForceSupport decode(v1::ForceSupport support, const FieldPath& path) {
  if (support == v1::FORCE_SUPPORT_NODAL) return ForceSupport::nodal;
  if (support == v1::FORCE_SUPPORT_STEP) return ForceSupport::step;
  if (support == v1::FORCE_SUPPORT_LINEAR) return ForceSupport::linear;
  path.fail(fmt::format("has an unknown value {}", static_cast<int>(support)));
}

}  // namespace abut
