#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(TimeWindow) == 3 * sizeof(double));
static_assert(sizeof(Want) == sizeof(double) + sizeof(std::vector<std::int32_t>));
static_assert(sizeof(Advance) ==
              sizeof(TimeWindow) + sizeof(double) + 2 * sizeof(std::vector<double>));

void encode(const TimeWindow& from, v1::TimeWindow& to) {
  to.set_index(from.index);
  to.set_begin(from.begin);
  to.set_end(from.end);
}

void decode(const v1::Advance& from, const FieldPath& parent, TimeWindow& to) {
  const FieldPath path{&parent, "window"};
  if (!from.has_window()) path.fail("is missing");
  to.index = from.window().index();
  to.begin = number(from.window().begin(), path);
  to.end = number(from.window().end(), path);
  if (to.end < to.begin) path.fail("ends before its begin");
}

void encode(const Want& from, v1::Want& to) {
  to.set_u(from.u);
  to.set_v(from.v);
  to.set_a(from.a);
  to.set_f(from.f);
  copy(from.points, *to.mutable_points());
}

void decode(const v1::Want& from, const SurfaceSize& port, const FieldPath& path, Want& to) {
  to.u = from.u();
  to.v = from.v();
  to.a = from.a();
  to.f = from.f();
  take_points(from.points(), port.points, FieldPath{&path, "points"}, to.points);
}

Sampling decode(v1::Sampling from, const FieldPath& path) {
  if (from == v1::SAMPLING_SUBSTEPS) return Sampling::substeps;
  if (from == v1::SAMPLING_RECORDS) return Sampling::records;
  path.fail("has an unknown value");
}

}  // namespace

void encode(const Advance& from, v1::Advance& to) {
  encode(from.window, *to.mutable_window());
  to.set_records(from.records);
  to.set_sampling(from.sampling == Sampling::substeps ? v1::SAMPLING_SUBSTEPS
                                                      : v1::SAMPLING_RECORDS);
  resize(*to.mutable_boundary(), from.boundary.size());
  for (int i = 0; i < to.boundary_size(); ++i) {
    encode(from.boundary[index(i)], *to.mutable_boundary(i));
  }
  resize(*to.mutable_want(), from.want.size());
  for (int i = 0; i < to.want_size(); ++i) encode(from.want[index(i)], *to.mutable_want(i));
}

void decode(const v1::Advance& from, const Description& body, const Partners& met, Advance& to) {
  const FieldPath path{nullptr, "advance"};
  decode(from, path, to.window);
  if (from.records() < 1 || from.records() > most_records) {
    FieldPath{&path, "records"}.fail(
        fmt::format("is {}, not 1 to {}", from.records(), most_records));
  }
  to.records = from.records();
  to.sampling = decode(from.sampling(), FieldPath{&path, "sampling"});
  const std::size_t ports = body.ports.size();
  require_count(from.boundary_size(), ports, "ports", FieldPath{&path, "boundary"});
  to.boundary.resize(ports);
  for (int p = 0; p < from.boundary_size(); ++p) {
    decode(from.boundary(p), size_of(body.ports[index(p)].geometry), met[index(p)],
           FieldPath{&path, "boundary", p}, to.boundary[index(p)]);
  }
  if (from.want_size() > 0)
    require_count(from.want_size(), ports, "ports", FieldPath{&path, "want"});
  to.want.resize(index(from.want_size()));
  for (int p = 0; p < from.want_size(); ++p) {
    decode(from.want(p), size_of(body.ports[index(p)].geometry), FieldPath{&path, "want", p},
           to.want[index(p)]);
  }
}

}  // namespace abut
