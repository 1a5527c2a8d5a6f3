#include <fmt/format.h>

#include <algorithm>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Obstacle) == sizeof(Waveform));
static_assert(sizeof(Impedance) == 2 * sizeof(double));
static_assert(sizeof(BoundaryData) ==
              sizeof(Waveform) + sizeof(Impedance) + 3 * sizeof(std::vector<double>));

/// Entries up to the last that is there; one between them that is absent has no times.
template <class T>
std::size_t filled(const std::vector<T>& entries) {
  std::size_t count = entries.size();
  while (count > 0 && entries[count - 1].empty()) --count;
  return count;
}

/// Room for so many entries; never less than before, so that their memory is kept.
template <class T>
void make_room(std::vector<T>& entries, int count) {
  if (entries.size() < index(count)) entries.resize(index(count));
}

void decode_motion(const v1::BoundaryData& from, const SurfaceSize& port, const FieldPath& path,
                   Waveform& to) {
  to.clear();
  if (!from.has_motion()) return;
  decode(from.motion(), port, path, to);
  if (to.empty()) path.fail("is present but empty");
  require_field(to, to.u, "u", path);
}

void decode_forces(const v1::BoundaryData& from, const SurfaceSize& port, const FieldPath& parent,
                   std::vector<Waveform>& to) {
  if (from.forces_size() > most_partners) FieldPath{&parent, "forces"}.fail("has too many entries");
  for (Waveform& force : to) force.clear();
  make_room(to, from.forces_size());
  for (int i = 0; i < from.forces_size(); ++i) {
    if (from.forces(i).time().empty()) continue;
    const FieldPath path{&parent, "forces", i};
    decode(from.forces(i), port, path, to[index(i)]);
    require_field(to[index(i)], to[index(i)].f, "f", path);
  }
}

void decode_obstacles(const v1::BoundaryData& from, const std::vector<SurfaceSize>& partners,
                      const FieldPath& parent, std::vector<Obstacle>& to) {
  if (index(from.obstacles_size()) > partners.size()) {
    FieldPath{&parent, "obstacles"}.fail(
        fmt::format("has {} entries, but the port has met {} partners", from.obstacles_size(),
                    partners.size()));
  }
  for (Obstacle& obstacle : to) obstacle.motion.clear();
  make_room(to, from.obstacles_size());
  for (int i = 0; i < from.obstacles_size(); ++i) {
    if (from.obstacles(i).motion().time().empty()) continue;
    const FieldPath obstacle{&parent, "obstacles", i};
    const FieldPath path{&obstacle, "motion"};
    Waveform& motion = to[index(i)].motion;
    decode(from.obstacles(i).motion(), partners[index(i)], path, motion);
    require_field(motion, motion.u, "u", path);
  }
}

}  // namespace

void encode(const BoundaryData& from, v1::BoundaryData& to) {
  if (from.motion.empty()) {
    to.clear_motion();
  } else {
    encode(from.motion, *to.mutable_motion());
  }
  resize(*to.mutable_forces(), filled(from.forces));
  for (int i = 0; i < to.forces_size(); ++i) {
    const Waveform& force = from.forces[index(i)];
    if (force.empty()) {
      to.mutable_forces(i)->Clear();
    } else {
      encode(force, *to.mutable_forces(i));
    }
  }
  resize(*to.mutable_obstacles(), filled(from.obstacles));
  for (int i = 0; i < to.obstacles_size(); ++i) {
    const Obstacle& obstacle = from.obstacles[index(i)];
    if (obstacle.empty()) {
      to.mutable_obstacles(i)->clear_motion();
    } else {
      encode(obstacle.motion, *to.mutable_obstacles(i)->mutable_motion());
    }
  }
  if (from.impedance.empty()) {
    to.clear_impedance();
  } else {
    to.mutable_impedance()->set_value(from.impedance.value);
    to.mutable_impedance()->set_bilateral(from.impedance.bilateral);
  }
  copy(from.impulse, *to.mutable_impulse());
}

void decode(const v1::BoundaryData& from, const SurfaceSize& port,
            const std::vector<SurfaceSize>& partners, const FieldPath& path, BoundaryData& to) {
  decode_motion(from, port, FieldPath{&path, "motion"}, to.motion);
  decode_forces(from, port, path, to.forces);
  decode_obstacles(from, partners, path, to.obstacles);
  to.impedance = {};
  if (from.has_impedance()) {
    const FieldPath impedance{&path, "impedance"};
    to.impedance = {number(from.impedance().value(), impedance), from.impedance().bilateral()};
    if (to.impedance.value <= 0.0) impedance.fail("is not positive");
  }
  take(from.impulse(), index(port.width()), true, FieldPath{&path, "impulse"}, to.impulse);
}

}  // namespace abut
