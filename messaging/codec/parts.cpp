#include "messaging/codec/parts.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

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

}  // namespace

std::string FieldPath::text() const {
  std::string text = parent != nullptr ? parent->text() : std::string();
  if (!text.empty()) text += '.';
  text += name;
  if (index >= 0) text += fmt::format("[{}]", index);
  return text;
}

void FieldPath::fail(const std::string& why) const { throw CodecError(text() + ' ' + why); }

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

void take_points(const google::protobuf::RepeatedField<std::int32_t>& from, int count,
                 const FieldPath& path, std::vector<std::int32_t>& to) {
  std::int32_t least = 0;
  for (int i = 0; i < from.size(); ++i) {
    const std::int32_t point = from.Get(i);
    if (point < 0 || point >= count) {
      path.fail(fmt::format("names point {}, but the surface has {}", point, count));
    }
    if (point < least) path.fail(fmt::format("does not ascend at entry {}", i));
    least = point + 1;
  }
  to.assign(from.begin(), from.end());
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

void require_count(int count, std::size_t expected, const char* of, const FieldPath& path) {
  if (index(count) == expected) return;
  path.fail(fmt::format("has {} entries for {} {}", count, expected, of));
}

v1::ForceSupport encode(ForceSupport support) {
  return support == ForceSupport::nodal ? v1::FORCE_SUPPORT_NODAL : v1::FORCE_SUPPORT_STEP;
}

ForceSupport decode(v1::ForceSupport support, const FieldPath& path) {
  if (support == v1::FORCE_SUPPORT_NODAL) return ForceSupport::nodal;
  if (support == v1::FORCE_SUPPORT_STEP) return ForceSupport::step;
  path.fail(fmt::format("has an unknown value {}", static_cast<int>(support)));
}

}  // namespace abut
