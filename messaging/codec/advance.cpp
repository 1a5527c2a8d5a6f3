#include <algorithm>

#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(TimeWindow) == 7 * sizeof(double));
static_assert(sizeof(Want) == sizeof(double) + sizeof(std::vector<std::int32_t>));
static_assert(sizeof(Advance) ==
              sizeof(TimeWindow) + 2 * sizeof(double) + 3 * sizeof(std::vector<double>));

/// Of a run: more than any body could advance through.
constexpr std::int64_t most_windows = 1'000'000'000'000;

using WireAdvance = v1::Advance;

void encode(const TimeWindow& from, WireWriter& to) {
  const std::size_t before = to.size();
  if (from.windows > 1) {
    to.number(v1::TimeWindow::kWholeFieldNumber, from.whole);
    to.number(v1::TimeWindow::kAnchorFieldNumber, from.anchor);
    to.integer(v1::TimeWindow::kSinceFieldNumber, from.since);
    to.integer(v1::TimeWindow::kWindowsFieldNumber, from.windows);
  }
  to.number(v1::TimeWindow::kEndFieldNumber, from.end);
  to.number(v1::TimeWindow::kBeginFieldNumber, from.begin);
  to.integer(v1::TimeWindow::kIndexFieldNumber, from.index);
  to.close(WireAdvance::kWindowFieldNumber, before);
}

void decode_window(Bytes bytes, const FieldPath& path, TimeWindow& to) {
  to = {};
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::TimeWindow::kIndexFieldNumber:
        to.index = from.integer();
        break;
      case v1::TimeWindow::kBeginFieldNumber:
        to.begin = number(from.number(), path);
        break;
      case v1::TimeWindow::kEndFieldNumber:
        to.end = number(from.number(), path);
        break;
      case v1::TimeWindow::kWindowsFieldNumber:
        to.windows = std::max<std::int64_t>(1, from.integer());
        break;
      case v1::TimeWindow::kSinceFieldNumber:
        to.since = from.integer();
        break;
      case v1::TimeWindow::kAnchorFieldNumber:
        to.anchor = number(from.number(), path);
        break;
      case v1::TimeWindow::kWholeFieldNumber:
        to.whole = number(from.number(), path);
        break;
      default:
        from.skip();
    }
  }
  if (to.end < to.begin) path.fail("ends before its begin");
  if (to.windows == 1) return;
  const bool counted = to.windows <= most_windows && to.since >= 0 && to.since <= most_windows;
  if (!counted || !(to.whole > 0.0 && to.stop(1) > to.begin && to.stop(to.windows - 1) < to.end))
    path.fail("does not lie as its windows do");
}

void encode(const Want& from, WireWriter& to) {
  const std::size_t before = to.size();
  to.integers(v1::Want::kPointsFieldNumber, from.points);
  to.integer(v1::Want::kFFieldNumber, from.f);
  to.integer(v1::Want::kAFieldNumber, from.a);
  to.integer(v1::Want::kVFieldNumber, from.v);
  to.integer(v1::Want::kUFieldNumber, from.u);
  to.close(WireAdvance::kWantFieldNumber, before);
}

void decode_want(Bytes bytes, const SurfaceSize& port, const FieldPath& path, Want& to) {
  to.u = to.v = to.a = to.f = false;
  to.points.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::Want::kUFieldNumber:
        to.u = from.integer() != 0;
        break;
      case v1::Want::kVFieldNumber:
        to.v = from.integer() != 0;
        break;
      case v1::Want::kAFieldNumber:
        to.a = from.integer() != 0;
        break;
      case v1::Want::kFFieldNumber:
        to.f = from.integer() != 0;
        break;
      case v1::Want::kPointsFieldNumber:
        from.integers(to.points);
        break;
      default:
        from.skip();
    }
  }
  check_points(to.points, port.points, FieldPath{&path, "points"});
}

Sampling decode_sampling(std::int64_t from, const FieldPath& path) {
  if (from == v1::SAMPLING_SUBSTEPS) return Sampling::substeps;
  if (from == v1::SAMPLING_RECORDS) return Sampling::records;
  path.fail("has an unknown value");
}

/// Of every substep all loose motions, or none.
void check_motions(const std::vector<double>& carry, const Description& body,
                   const FieldPath& path) {
  if (carry.empty()) return;
  const std::size_t each = index(loose_motions(body));
  if (each == 0) path.fail("is of a body without loose motions");
  if (carry.size() % each != 0)
    path.fail(fmt::format("has {} values, not a multiple of {}", carry.size(), each));
  check(carry, carry.size(), false, path);
}

int decode_records(std::int64_t from, const FieldPath& path) {
  if (from >= 1 && from <= most_records) return static_cast<int>(from);
  path.fail(fmt::format("is {}, not 1 to {}", from, most_records));
}

/// The surface of the port that an entry of this place is for.
SurfaceSize surface_at(const Description& body, std::size_t place, const FieldPath& path) {
  if (place < body.ports.size()) return size_of(body.ports[place].geometry);
  path.fail(fmt::format("has more entries than the body's {} ports", body.ports.size()));
}

}  // namespace

void encode(const Advance& from, WireWriter& to) {
  to.numbers(WireAdvance::kCarryFieldNumber, from.carry);
  to.number(WireAdvance::kAheadFieldNumber, from.ahead);
  for (std::size_t i = from.want.size(); i-- > 0;) encode(from.want[i], to);
  for (std::size_t i = from.boundary.size(); i-- > 0;) {
    const std::size_t before = to.size();
    encode(from.boundary[i], to);
    to.close(WireAdvance::kBoundaryFieldNumber, before);
  }
  to.integer(WireAdvance::kSamplingFieldNumber,
             from.sampling == Sampling::substeps ? v1::SAMPLING_SUBSTEPS : v1::SAMPLING_RECORDS);
  to.integer(WireAdvance::kRecordsFieldNumber, from.records);
  encode(from.window, to);
}

void decode(Bytes bytes, const Description& body, const Partners& met, Advance& to) {
  const FieldPath path{nullptr, "advance"};
  const FieldPath boundary{&path, "boundary"}, want{&path, "want"};
  const std::size_t ports = body.ports.size();
  to.boundary.resize(ports);
  if (to.want.size() < ports) to.want.resize(ports);  // whose memory is kept
  std::size_t boundaries = 0, wants = 0;
  std::int64_t records = 0, sampling = 0;
  bool windowed = false;
  to.ahead = 0.0;
  to.carry.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case WireAdvance::kWindowFieldNumber:
        decode_window(from.message(), FieldPath{&path, "window"}, to.window);
        windowed = true;
        break;
      case WireAdvance::kRecordsFieldNumber:
        records = from.integer();
        break;
      case WireAdvance::kSamplingFieldNumber:
        sampling = from.integer();
        break;
      case WireAdvance::kAheadFieldNumber:
        to.ahead = number(from.number(), FieldPath{&path, "ahead"}, Allow::not_negative);
        break;
      case WireAdvance::kCarryFieldNumber:
        from.numbers(to.carry);
        break;
      case WireAdvance::kBoundaryFieldNumber: {
        const SurfaceSize surface = surface_at(body, boundaries, boundary);
        decode(from.message(), surface, met[boundaries],
               FieldPath{&path, "boundary", static_cast<int>(boundaries)}, to.boundary[boundaries]);
        ++boundaries;
        break;
      }
      case WireAdvance::kWantFieldNumber: {
        const SurfaceSize surface = surface_at(body, wants, want);
        decode_want(from.message(), surface, FieldPath{&path, "want", static_cast<int>(wants)},
                    to.want[wants]);
        ++wants;
        break;
      }
      default:
        from.skip();
    }
  }
  if (!windowed) FieldPath{&path, "window"}.fail("is missing");
  to.records = decode_records(records, FieldPath{&path, "records"});
  to.sampling = decode_sampling(sampling, FieldPath{&path, "sampling"});
  require_count(boundaries, ports, "ports", boundary);
  if (wants > 0) require_count(wants, ports, "ports", want);
  to.want.resize(wants);
  check_motions(to.carry, body, FieldPath{&path, "carry"});
}

}  // namespace abut
