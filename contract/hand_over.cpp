#include "contract/hand_over.hpp"

#include <cstdint>


namespace abut {
namespace {

void numbers(Archive& archive, const char* name, std::vector<std::int32_t>& values) {
  std::vector<double> list(values.begin(), values.end());  // exact: they are far below 2^53
  archive.field(name, list);
  if (!archive.writing()) values.assign(list.begin(), list.end());
}

}  // namespace

void HandOver::state(Archive& archive) {
  archive.field("model", model);
  archive.field("deforms", deforms);
  archive.field("points", grid.points);
  numbers(archive, "types", grid.types);
  numbers(archive, "connectivity", grid.connectivity);
  numbers(archive, "offsets", grid.offsets);
  archive.field("displacement", displacement);
  archive.field("velocity", velocity);
  archive.field("mass", mass);
  archive.field("time", record.time);
  archive.field("kinetic", record.energy.kinetic);
  archive.field("stored", record.energy.stored);
  archive.field("dissipated", record.energy.dissipated);
  archive.field("external_work", record.energy.external_work);
  archive.field("momentum", record.momentum);
  archive.field("angular_momentum", record.angular_momentum);
  std::int64_t count = static_cast<std::int64_t>(columns.size());
  archive.field("columns", count);
  archive.check_count("columns", count);
  columns.resize(static_cast<std::size_t>(count));
  for (std::string& name : columns) archive.field("name", name);
}

std::vector<std::byte> HandOver::bytes() {
  std::vector<std::byte> out;
  Archive archive = Archive::writer(out, Archive::Form::named);
  std::string kind = handed_over;
  archive.field("scheme", kind);
  state(archive);
  archive.finish();
  return out;
}

HandOver HandOver::from(std::span<const std::byte> bytes) {
  HandOver handed;
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  std::string kind;
  archive.field("scheme", kind);
  handed.state(archive);
  archive.finish();
  return handed;
}

bool same_grid(const Grid& one, const Grid& other) {
  return one.points == other.points && one.types == other.types &&
         one.connectivity == other.connectivity;
}

}  // namespace abut
