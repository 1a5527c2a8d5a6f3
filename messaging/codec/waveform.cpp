#include <fmt/format.h>

#include <utility>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Waveform) == sizeof(double) + 6 * sizeof(std::vector<double>));

using W = v1::Waveform;

void encode(const Waveform& from, const Want& want, int field, WireWriter& to) {
  const std::size_t before = to.size();
  to.integers(W::kPointsFieldNumber, from.points);
  if (want.f) to.numbers(W::kFFieldNumber, from.f);
  if (want.a) to.numbers(W::kAFieldNumber, from.a);
  if (want.v) to.numbers(W::kVFieldNumber, from.v);
  if (want.u) to.numbers(W::kUFieldNumber, from.u);
  to.numbers(W::kTimeFieldNumber, from.time);
  to.integer(W::kSupportFieldNumber, encode(from.support));
  to.integer(W::kWidthFieldNumber, from.width);
  to.close(field, before);
}

namespace {

/// What the bytes hold, whatever it is worth; the support.
std::int64_t read_values(WireReader from, Waveform& to) {
  to.points.clear();
  bool time = false, u = false, v = false, a = false, f = false;
  std::int64_t support = 0, width = 0;
  while (from.next()) {
    switch (from.field()) {
      case W::kWidthFieldNumber:
        width = from.integer();
        break;
      case W::kSupportFieldNumber:
        support = from.integer();
        break;
      case W::kTimeFieldNumber:
        from.numbers(to.time, time);
        break;
      case W::kUFieldNumber:
        from.numbers(to.u, u);
        break;
      case W::kVFieldNumber:
        from.numbers(to.v, v);
        break;
      case W::kAFieldNumber:
        from.numbers(to.a, a);
        break;
      case W::kFFieldNumber:
        from.numbers(to.f, f);
        break;
      case W::kPointsFieldNumber:
        from.integers(to.points);
        break;
      default:
        from.skip();
    }
  }
  for (const auto& [there, field] :
       {std::pair{time, &to.time}, {u, &to.u}, {v, &to.v}, {a, &to.a}, {f, &to.f}}) {
    if (!there) field->clear();
  }
  to.width = static_cast<int>(width);
  return support;
}

}  // namespace

void decode(Bytes from, const SurfaceSize& surface, const FieldPath& path, Waveform& to) {
  const std::int64_t support = read_values(WireReader(from, path), to);
  check_points(to.points, surface.points, FieldPath{&path, "points"});
  const int points = to.points.empty() ? surface.points : static_cast<int>(to.points.size());
  if (to.width != points * surface.dim) {
    FieldPath{&path, "width"}.fail(
        fmt::format("is {}, but {} points of dimension {} are {} numbers", to.width, points,
                    surface.dim, points * surface.dim));
  }
  to.support = decode(static_cast<v1::ForceSupport>(support), FieldPath{&path, "support"});
  check(to.time, to.time.size(), false, FieldPath{&path, "time"});
  for (std::size_t i = 1; i < to.time.size(); ++i) {
    if (to.time[i] > to.time[i - 1]) continue;
    FieldPath{&path, "time"}.fail(fmt::format("does not increase at entry {}", i));
  }
  const std::size_t count = to.time.size() * index(to.width);
  check(to.u, count, true, FieldPath{&path, "u"});
  check(to.v, count, true, FieldPath{&path, "v"});
  check(to.a, count, true, FieldPath{&path, "a"});
  check(to.f, count, true, FieldPath{&path, "f"});
}

void require_field(const Waveform& of, const std::vector<double>& field, const char* name,
                   const FieldPath& path) {
  if (!of.empty() && field.empty()) FieldPath{&path, name}.fail("is missing");
}

}  // namespace abut
