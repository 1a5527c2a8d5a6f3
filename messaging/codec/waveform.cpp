#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Waveform) == sizeof(double) + 6 * sizeof(std::vector<double>));

void encode(const Waveform& from, v1::Waveform& to) {
  to.set_width(from.width);
  to.set_support(encode(from.support));
  copy(from.points, *to.mutable_points());
  copy(from.time, *to.mutable_time());
  copy(from.u, *to.mutable_u());
  copy(from.v, *to.mutable_v());
  copy(from.a, *to.mutable_a());
  copy(from.f, *to.mutable_f());
}

void decode(const v1::Waveform& from, const SurfaceSize& surface, const FieldPath& path,
            Waveform& to) {
  take_points(from.points(), surface.points, FieldPath{&path, "points"}, to.points);
  const int points = to.points.empty() ? surface.points : static_cast<int>(to.points.size());
  if (from.width() != points * surface.dim) {
    FieldPath{&path, "width"}.fail(
        fmt::format("is {}, but {} points of dimension {} are {} numbers", from.width(), points,
                    surface.dim, points * surface.dim));
  }
  to.width = from.width();
  to.support = decode(from.support(), FieldPath{&path, "support"});
  take(from.time(), FieldPath{&path, "time"}, to.time);
  for (std::size_t i = 1; i < to.time.size(); ++i) {
    if (to.time[i] > to.time[i - 1]) continue;
    FieldPath{&path, "time"}.fail(fmt::format("does not increase at entry {}", i));
  }
  const std::size_t count = to.time.size() * index(to.width);
  take(from.u(), count, true, FieldPath{&path, "u"}, to.u);
  take(from.v(), count, true, FieldPath{&path, "v"}, to.v);
  take(from.a(), count, true, FieldPath{&path, "a"}, to.a);
  take(from.f(), count, true, FieldPath{&path, "f"}, to.f);
}

void require_field(const Waveform& of, const std::vector<double>& field, const char* name,
                   const FieldPath& path) {
  if (!of.empty() && field.empty()) FieldPath{&path, name}.fail("is missing");
}

}  // namespace abut
