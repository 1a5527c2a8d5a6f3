#include "messaging/codec/parts.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

/// An exponent of all ones, one more added to it, carries into the sign's place. Comparing each
/// number would keep the loop from running at full speed.
bool all_finite(const double* values, std::size_t count) {
  constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000, one_more = 0x0010'0000'0000'0000;
  std::uint64_t carried = 0;
  for (std::size_t i = 0; i < count; ++i)
    carried |= (std::bit_cast<std::uint64_t>(values[i]) & exponent) + one_more;
  return carried >> 63 == 0;
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
  if (all_finite(values.data(), count)) return;
  std::size_t first = 0;
  while (std::isfinite(values[first])) ++first;
  path.fail(fmt::format("is not finite: entry {} is {}", first, values[first]));
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

void take_names(const google::protobuf::RepeatedPtrField<std::string>& from, const FieldPath& path,
                std::vector<std::string>& to) {
  if (from.size() > most_names) path.fail("has too many entries");
  to.assign(from.begin(), from.end());
}

double number(double value, const FieldPath& path, Allow allow) {
  const bool may_be_infinite = allow == Allow::infinite || allow == Allow::not_negative_or_inf;
  const bool good = may_be_infinite ? !std::isnan(value) : std::isfinite(value);
  if (!good) path.fail(fmt::format("is not finite: {}", value));
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
