#include "coordinator/record/swaps_json.hpp"

#include "base/archive_lists.hpp"

namespace abut {

namespace {

using Json = nlohmann::ordered_json;

Json pair_of(double before, double after) {
  Json object = Json::object();
  object["before"] = before;
  object["after"] = after;
  return object;
}

Json pair_of(const std::vector<double>& before, const std::vector<double>& after) {
  Json object = Json::object();
  object["before"] = before;
  object["after"] = after;
  return object;
}

void energies(Archive& archive, BodyRecord& record) {
  archive.field("kinetic", record.energy.kinetic);
  archive.field("stored", record.energy.stored);
  archive.field("dissipated", record.energy.dissipated);
  archive.field("external_work", record.energy.external_work);
  archive.field("momentum", record.momentum);
  archive.field("angular_momentum", record.angular_momentum);
}

}  // namespace

void Swap::state(Archive& archive) {
  archive.field("time", time);
  archive.field("body", body);
  archive.field("from", from);
  archive.field("to", to);
  field(archive, "mass", mass);
  energies(archive, before);
  energies(archive, after);
}

Json swaps_json(std::span<const Swap> swaps) {
  Json array = Json::array();
  for (const Swap& swap : swaps) {
    Json entry = Json::object();
    entry["time"] = swap.time;
    entry["body"] = swap.body;
    entry["from"] = swap.from;
    entry["to"] = swap.to;
    entry["mass"] = pair_of(swap.mass[0], swap.mass[1]);
    entry["momentum"] = pair_of(swap.before.momentum, swap.after.momentum);
    entry["angular_momentum"] =
        pair_of(swap.before.angular_momentum, swap.after.angular_momentum);
    entry["kinetic"] = pair_of(swap.before.energy.kinetic, swap.after.energy.kinetic);
    entry["stored"] = pair_of(swap.before.energy.stored, swap.after.energy.stored);
    entry["given_up"] = swap.given_up();
    array.push_back(std::move(entry));
  }
  return array;
}

}  // namespace abut
