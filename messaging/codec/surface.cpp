#include <fmt/format.h>

#include "base/index.hpp"
#include "contract/whole_facets.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(PortGeometry) ==
              5 * sizeof(std::vector<double>) + 4 * sizeof(double));  // dim, round and embedded

/// Facets are nodes one facet after the other; offsets say where each begins, and the last ends.
void check_facets(const PortGeometry& surface, const FieldPath& path) {
  for (const std::int32_t point : surface.facets) {
    if (point >= 0 && point < surface.count()) continue;
    FieldPath{&path, "facets"}.fail(fmt::format("names point {}", point));
  }
  const FieldPath offsets{&path, "offsets"};
  if (surface.offsets.empty() && surface.facets.empty()) return;
  if (surface.offsets.empty() || surface.offsets.front() != 0) offsets.fail("does not begin at 0");
  for (std::size_t i = 1; i < surface.offsets.size(); ++i) {
    if (surface.offsets[i] > surface.offsets[i - 1]) continue;
    offsets.fail(fmt::format("does not increase at entry {}", i));
  }
  if (index(surface.offsets.back()) != surface.facets.size()) {
    offsets.fail(fmt::format("ends at {}, but facets has {} entries", surface.offsets.back(),
                             surface.facets.size()));
  }
}

}  // namespace

SurfaceSize size_of(const PortGeometry& surface) { return {surface.count(), surface.dim}; }

void encode(const PortGeometry& from, v1::Surface& to) {
  to.set_dim(from.dim);
  copy(from.points, *to.mutable_points());
  copy(from.normals, *to.mutable_normals());
  copy(from.facets, *to.mutable_facets());
  copy(from.offsets, *to.mutable_offsets());
  to.set_spacing(from.spacing);
  to.set_transit(from.transit);
  to.set_round(from.round);
  to.set_embedded(from.embedded);
  copy(from.parts, *to.mutable_parts());
}

void decode(const v1::Surface& from, const FieldPath& path, PortGeometry& to) {
  to.dim = dimension(from.dim(), FieldPath{&path, "dim"});
  const FieldPath points{&path, "points"};
  if (from.points_size() > most_width) points.fail("has too many entries");
  take(from.points(), points, to.points);
  if (to.points.size() % index(to.dim) != 0) points.fail("is no whole number of points");
  take(from.normals(), to.points.size(), false, FieldPath{&path, "normals"}, to.normals);
  to.facets.assign(from.facets().begin(), from.facets().end());
  to.offsets.assign(from.offsets().begin(), from.offsets().end());
  check_facets(to, path);
  to.spacing = number(from.spacing(), FieldPath{&path, "spacing"}, Allow::not_negative);
  to.transit = number(from.transit(), FieldPath{&path, "transit"}, Allow::not_negative);
  to.round = from.round();
  if (to.round && to.dim != 2) FieldPath{&path, "round"}.fail("is not for this dimension");
  to.embedded = from.embedded();
  if (to.embedded < 0 || to.embedded > to.count())
    FieldPath{&path, "embedded"}.fail(fmt::format("is {} of {} points", to.embedded, to.count()));
  to.parts.assign(from.parts().begin(), from.parts().end());
  if (const std::string wrong = unsound_parts(to); !wrong.empty())
    FieldPath{&path, "parts"}.fail(wrong);
}

}  // namespace abut
