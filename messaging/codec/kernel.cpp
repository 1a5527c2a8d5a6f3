#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(KernelBand) == sizeof(double) + 2 * sizeof(std::vector<double>));
static_assert(sizeof(PortKernel) ==
              3 * sizeof(double) + 6 * sizeof(std::vector<double>) + sizeof(KernelBand));

/// Lists of points, one for each that is pressed.
void decode(const v1::PortKernel& from, int patterns, int width, int dim, const FieldPath& path,
            KernelBand& to) {
  to = {};
  const FieldPath offsets{&path, "band_offsets"}, reached{&path, "band_points"};
  if (from.band_offsets_size() == 0) {
    if (from.band_points_size() > 0) reached.fail("is given without band_offsets");
    return;
  }
  if (dim < 1 || patterns % dim != 0 || from.band_offsets_size() != patterns / dim + 1)
    offsets.fail(fmt::format("has {} numbers for {} patterns", from.band_offsets_size(), patterns));
  to.dim = dim;
  to.offsets.assign(from.band_offsets().begin(), from.band_offsets().end());
  to.reached.assign(from.band_points().begin(), from.band_points().end());
  if (to.offsets.front() != 0 || to.offsets.back() != from.band_points_size())
    offsets.fail(fmt::format("does not go from 0 to {}", from.band_points_size()));
  for (std::size_t p = 0; p + 1 < to.offsets.size(); ++p) {
    const std::int32_t begin = to.offsets[p], end = to.offsets[p + 1];
    if (begin < 0 || end <= begin || end > from.band_points_size())
      offsets.fail("has a list that is empty or out of order");
    check_points({to.reached.begin() + begin, to.reached.begin() + end}, width / dim, reached);
  }
}

}  // namespace

void decode(const v1::PortKernel& from, int patterns, int width, int dim, const FieldPath& path,
            PortKernel& to) {
  to.step = number(from.step(), FieldPath{&path, "step"}, Allow::not_negative);
  to.support = decode(from.support(), FieldPath{&path, "support"});
  if (from.width() != width) {
    FieldPath{&path, "width"}.fail(
        fmt::format("is {}, but the surface's is {}", from.width(), width));
  }
  if (from.patterns() != patterns) {
    FieldPath{&path, "patterns"}.fail(fmt::format("is {}, not {}", from.patterns(), patterns));
  }
  to.patterns = patterns;
  to.width = width;
  decode(from, patterns, width, dim, path, to.band);
  take(from.compliance(), to.per_step(), true, FieldPath{&path, "compliance"}, to.compliance);
  const FieldPath displacement{&path, "displacement"};
  if (index(from.displacement_size()) % to.per_step() != 0) {
    displacement.fail(fmt::format("has {} numbers, no whole number of substeps of {}",
                                  from.displacement_size(), to.per_step()));
  }
  take(from.displacement(), displacement, to.displacement);
  take(from.begin(), to.displacement.size(), true, FieldPath{&path, "begin"}, to.begin);
}

void encode(const Probing& from, v1::Probe& to) {
  to.set_port(from.port);
  to.set_step(from.step);
  to.set_count(from.count);
  copy(from.patterns, *to.mutable_patterns());
  to.mutable_seen()->Assign(from.seen.begin(), from.seen.end());
}

void decode(const v1::Probe& from, const Description& body, Probing& to) {
  const FieldPath path{nullptr, "probe"};
  to.port = position(from.port(), body.ports.size(), FieldPath{&path, "port"});
  to.step = number(from.step(), FieldPath{&path, "step"}, Allow::not_negative);
  to.count = from.count();
  if (to.count < 1 || to.count > most_kernel_steps || to.step == 0.0) {
    path.fail(fmt::format("of {} steps of {} s is out of range", to.count, to.step));
  }
  const FieldPath patterns{&path, "patterns"};
  const std::size_t width = index(size_of(body.ports[to.port].geometry).width());
  take(from.patterns(), patterns, to.patterns);
  if (to.patterns.empty() || width == 0 || to.patterns.size() % width != 0) {
    patterns.fail(fmt::format("has {} numbers, no whole number of patterns of {}",
                              to.patterns.size(), width));
  }
  to.seen.clear();
  for (const std::int32_t port : from.seen())
    to.seen.push_back(position(port, body.ports.size(), FieldPath{&path, "seen"}));
}

void encode(const PortKernel& from, v1::PortKernel& to) {
  to.Clear();
  to.set_step(from.step);
  to.set_support(encode(from.support));
  to.set_patterns(from.patterns);
  to.set_width(from.width);
  copy(from.compliance, *to.mutable_compliance());
  copy(from.displacement, *to.mutable_displacement());
  copy(from.begin, *to.mutable_begin());
  copy(from.carried, *to.mutable_carried());
  copy(from.left, *to.mutable_left());
  to.mutable_points()->Assign(from.points.begin(), from.points.end());
  to.mutable_band_offsets()->Assign(from.band.offsets.begin(), from.band.offsets.end());
  to.mutable_band_points()->Assign(from.band.reached.begin(), from.band.reached.end());
}

void decode(const v1::PortKernel& from, const Description& body, const Probing& asked,
            PortKernel& to) {
  const FieldPath path{nullptr, "kernel"};
  if (from.points_size() > 0) FieldPath{&path, "points"}.fail("was not asked for");
  if (from.band_offsets_size() > 0) FieldPath{&path, "band_offsets"}.fail("was not asked for");
  to.points.clear();
  const auto width_of = [&body](int port) { return size_of(body.ports[port].geometry).width(); };
  int width = asked.seen.empty() ? width_of(asked.port) : 0;
  for (const int port : asked.seen) width += width_of(port);
  decode(from, static_cast<int>(asked.patterns.size()) / width_of(asked.port), width, 0, path, to);
  const std::size_t motions = index(loose_motions(body));
  take(from.carried(), motions * index(width), true, FieldPath{&path, "carried"}, to.carried);
  take(from.left(), motions * motions, true, FieldPath{&path, "left"}, to.left);
  if (to.count() == asked.count) return;
  FieldPath{&path, "displacement"}.fail(
      fmt::format("has {} substeps where {} were asked for", to.count(), asked.count));
}

}  // namespace abut
