#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Dense>

#include "base/archive_lists.hpp"
#include "contract/outcome.hpp"
#include "contract/port.hpp"
#include "contract/waveform.hpp"

namespace abut {

// Fields of state lists that are more than numbers and lists of numbers.

inline void field(Archive& archive, std::string_view name, Eigen::VectorXd& values) {
  std::vector<double> list(values.begin(), values.end());
  archive.field(name, list);
  if (archive.writing()) return;
  values = Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

inline void field(Archive& archive, std::string_view name, std::vector<std::int32_t>& values) {
  std::vector<double> list(values.begin(), values.end());  // exact: they are far below 2^53
  archive.field(name, list);
  if (!archive.writing()) values.assign(list.begin(), list.end());
}

inline void field(Archive& archive, std::string_view name, std::vector<Eigen::Vector3d>& places) {
  std::vector<double> list(3 * places.size());
  for (std::size_t k = 0; k < list.size(); ++k)
    list[k] = places[k / 3](static_cast<Eigen::Index>(k % 3));
  archive.field(name, list);
  places.resize(list.size() / 3);
  for (std::size_t k = 0; k < list.size(); ++k)
    places[k / 3](static_cast<Eigen::Index>(k % 3)) = list[k];
}

inline void field(Archive& archive, std::string_view name, Waveform& wave) {
  whole(archive, name, wave.width);
  whole(archive, "support", wave.support);
  field(archive, "points", wave.points);
  archive.field("time", wave.time);
  archive.field("u", wave.u);
  archive.field("v", wave.v);
  archive.field("a", wave.a);
  archive.field("f", wave.f);
}

inline void field(Archive& archive, std::string_view name, PortKernel& kernel) {
  archive.field(name, kernel.step);
  whole(archive, "support", kernel.support);
  whole(archive, "patterns", kernel.patterns);
  whole(archive, "width", kernel.width);
  archive.field("compliance", kernel.compliance);
  archive.field("displacement", kernel.displacement);
  archive.field("begin", kernel.begin);
  field(archive, "points", kernel.points);
  whole(archive, "dim", kernel.band.dim);
  field(archive, "offsets", kernel.band.offsets);
  field(archive, "reached", kernel.band.reached);
  archive.field("carried", kernel.carried);
  archive.field("left", kernel.left);
}

inline void field(Archive& archive, std::string_view name, Energy& energy) {
  archive.field(name, energy.kinetic);
  archive.field("stored", energy.stored);
  archive.field("dissipated", energy.dissipated);
  archive.field("external_work", energy.external_work);
}

inline void field(Archive& archive, std::string_view name, BodyRecord& record) {
  archive.field(name, record.time);
  field(archive, "energy", record.energy);
  archive.field("momentum", record.momentum);
  archive.field("angular_momentum", record.angular_momentum);
  archive.field("columns", record.columns);
  list(archive, "members", record.members, [](Archive& a, MemberRecord& member) {
    field(a, "energy", member.energy);
    a.field("momentum", member.momentum);
  });
}

inline void field(Archive& archive, std::string_view name, PortResponse& port) {
  field(archive, name, port.trace);
  list(archive, "reactions", port.reactions, [](Archive& a, Reaction& reaction) {
    field(a, "reaction", reaction.force);
    a.field("dissipated", reaction.dissipated);
  });
  field(archive, "ahead", port.ahead);
  for (std::vector<double>* box : {&port.lower, &port.upper, &port.slowest, &port.fastest})
    archive.field("box", *box);
  archive.field("speed_bound", port.speed_bound);
  archive.field("acceleration_bound", port.acceleration_bound);
  bool recoils = port.recoil.has_value();
  archive.field("recoils", recoils);
  if (recoils && !port.recoil) port.recoil.emplace();
  if (recoils) {
    archive.field("velocity", port.recoil->velocity);
    archive.field("mobility", port.recoil->mobility);
  }
  archive.field("work", port.work);
}

/// Without what a clock measured.
inline void field(Archive& archive, std::string_view name, Response& response) {
  whole(archive, name, response.steps);
  archive.field("unbalanced", response.unbalanced);
  list(archive, "ports", response.ports,
       [](Archive& a, PortResponse& port) { field(a, "port", port); });
  list(archive, "records", response.records,
       [](Archive& a, BodyRecord& record) { field(a, "record", record); });
}

}  // namespace abut
