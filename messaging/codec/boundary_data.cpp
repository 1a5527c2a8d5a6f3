#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Obstacle) == sizeof(Waveform) + sizeof(std::vector<std::int32_t>));
static_assert(sizeof(Impedance) == 2 * sizeof(double));
static_assert(sizeof(BoundaryData) ==
              2 * sizeof(Waveform) + sizeof(Impedance) + 3 * sizeof(std::vector<double>));

using WireBoundary = v1::BoundaryData;

/// Entries up to the last that is there; one between them that is absent has no times.
template <class T>
std::size_t filled(const std::vector<T>& entries) {
  std::size_t count = entries.size();
  while (count > 0 && entries[count - 1].empty()) --count;
  return count;
}

/// The next entry, which keeps the memory of an earlier message.
template <class T>
T& entry(std::vector<T>& entries, std::size_t place) {
  if (place == entries.size()) entries.emplace_back();
  return entries[place];
}

Impedance decode_impedance(Bytes bytes, const FieldPath& path) {
  Impedance to{0.0, false};
  for (WireReader from(bytes, path); from.next();) {
    if (from.field() == v1::Impedance::kValueFieldNumber) {
      to.value = abut::number(from.number(), path);
    } else if (from.field() == v1::Impedance::kBilateralFieldNumber) {
      to.bilateral = from.integer() != 0;
    } else {
      from.skip();
    }
  }
  if (to.value <= 0.0) path.fail("is not positive");
  return to;
}

void decode_force(Bytes from, const SurfaceSize& port, const FieldPath& path, Waveform& to) {
  if (from.empty()) return to.clear();  // absent
  decode(from, port, path, to);
  require_field(to, to.f, "f", path);
}

void decode_motion(Bytes from, const SurfaceSize& surface, const FieldPath& path, Waveform& to) {
  decode(from, surface, path, to);
  if (to.empty()) path.fail("is present but empty");
  require_field(to, to.u, "u", path);
}

void decode_obstacle(Bytes bytes, const SurfaceSize& partner, const FieldPath& path, Obstacle& to) {
  Bytes motion;
  to.slid.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::Obstacle::kMotionFieldNumber:
        motion = from.message();
        break;
      case v1::Obstacle::kSlidFieldNumber:
        from.integers(to.slid);
        break;
      default:
        from.skip();
    }
  }
  check_slid(to.slid, std::numeric_limits<std::int32_t>::max(), FieldPath{&path, "slid"});
  if (motion.empty()) return to.clear();  // absent
  decode_motion(motion, partner, FieldPath{&path, "motion"}, to.motion);
}

/// Of all points of the port, which bodies that are tied respond at.
void decode_balanced(Bytes from, const SurfaceSize& port, const FieldPath& path, Waveform& to) {
  decode_force(from, port, path, to);
  if (to.empty()) path.fail("is present but empty");
  if (!to.points.empty()) FieldPath{&path, "points"}.fail("is not of all points");
}

}  // namespace

void encode(const BoundaryData& from, WireWriter& to) {
  if (!from.balanced.empty()) encode(from.balanced, Want{}, WireBoundary::kBalancedFieldNumber, to);
  if (!from.impedance.empty()) {
    const std::size_t before = to.size();
    to.integer(v1::Impedance::kBilateralFieldNumber, from.impedance.bilateral);
    to.number(v1::Impedance::kValueFieldNumber, from.impedance.value);
    to.close(WireBoundary::kImpedanceFieldNumber, before);
  }
  to.numbers(WireBoundary::kImpulseFieldNumber, from.impulse);
  for (std::size_t i = filled(from.obstacles); i-- > 0;) {
    const std::size_t before = to.size();
    const Waveform& motion = from.obstacles[i].motion;
    to.integers(v1::Obstacle::kSlidFieldNumber, from.obstacles[i].slid);
    if (!motion.empty()) encode(motion, Want{}, v1::Obstacle::kMotionFieldNumber, to);
    to.close(WireBoundary::kObstaclesFieldNumber, before);
  }
  for (std::size_t i = filled(from.forces); i-- > 0;) {
    if (from.forces[i].empty()) {
      to.close(WireBoundary::kForcesFieldNumber, to.size());
    } else {
      encode(from.forces[i], Want{}, WireBoundary::kForcesFieldNumber, to);
    }
  }
  if (!from.motion.empty()) encode(from.motion, Want{}, WireBoundary::kMotionFieldNumber, to);
}

void decode(Bytes bytes, const SurfaceSize& port, const std::vector<SurfaceSize>& partners,
            const FieldPath& path, BoundaryData& to) {
  // Waveforms are overwritten where they are: clearing them first would cost a pass over each.
  to.impedance = {};
  to.impulse.clear();
  std::size_t forces = 0, obstacles = 0;
  bool moved = false, balanced = false;
  for (WireReader from(bytes, path); from.next();) {
    const FieldPath force{&path, "forces", static_cast<int>(forces)};
    const FieldPath obstacle{&path, "obstacles", static_cast<int>(obstacles)};
    switch (from.field()) {
      case WireBoundary::kMotionFieldNumber:
        decode_motion(from.message(), port, FieldPath{&path, "motion"}, to.motion);
        moved = true;
        break;
      case WireBoundary::kForcesFieldNumber:
        if (forces >= most_partners) FieldPath{&path, "forces"}.fail("has too many entries");
        decode_force(from.message(), port, force, entry(to.forces, forces));
        ++forces;
        break;
      case WireBoundary::kObstaclesFieldNumber:
        if (obstacles >= partners.size()) {
          obstacle.fail(fmt::format("is of nobody: the port has met {} partners", partners.size()));
        }
        decode_obstacle(from.message(), partners[obstacles], obstacle,
                        entry(to.obstacles, obstacles));
        ++obstacles;
        break;
      case WireBoundary::kImpulseFieldNumber:
        from.numbers(to.impulse);
        break;
      case WireBoundary::kImpedanceFieldNumber:
        to.impedance = decode_impedance(from.message(), FieldPath{&path, "impedance"});
        break;
      case WireBoundary::kBalancedFieldNumber:
        decode_balanced(from.message(), port, FieldPath{&path, "balanced"}, to.balanced);
        balanced = true;
        break;
      default:
        from.skip();
    }
  }
  if (!moved) to.motion.clear();
  if (!balanced) to.balanced.clear();
  for (; forces < to.forces.size(); ++forces) to.forces[forces].clear();
  for (; obstacles < to.obstacles.size(); ++obstacles) to.obstacles[obstacles].clear();
  check(to.impulse, index(port.width()), true, FieldPath{&path, "impulse"});
}

}  // namespace abut
