#include <array>
#include <utility>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(FieldInfo) == sizeof(std::string) + 2 * sizeof(std::int32_t));
static_assert(sizeof(Grid) == 4 * sizeof(std::vector<double>));

void refuse(const FieldPath& path, const std::string& why) {
  if (!why.empty()) path.fail("is unsound: " + why);
}

FieldPlace decode(v1::FieldPlace place, const FieldPath& path) {
  if (place == v1::FIELD_PLACE_NODES) return FieldPlace::nodes;
  if (place == v1::FIELD_PLACE_CELLS) return FieldPlace::cells;
  path.fail("has an unknown value");
}

}  // namespace

void encode(const std::vector<FieldInfo>& from, v1::Description& to) {
  to.clear_fields();
  for (const FieldInfo& field : from) {
    v1::Field& wire = *to.add_fields();
    wire.set_name(field.name);
    wire.set_place(field.place == FieldPlace::nodes ? v1::FIELD_PLACE_NODES
                                                    : v1::FIELD_PLACE_CELLS);
    wire.set_components(field.components);
  }
}

void decode(const v1::Description& from, const FieldPath& path, std::vector<FieldInfo>& to) {
  to.clear();
  for (int i = 0; i < from.fields_size(); ++i) {
    const FieldPath field{&path, "fields", i};
    to.push_back({from.fields(i).name(), decode(from.fields(i).place(), FieldPath{&field, "place"}),
                  from.fields(i).components()});
  }
  refuse(FieldPath{&path, "fields"}, unsound(to));
}

void encode(const Grid& from, v1::GridReply& to) {
  copy(from.points, *to.mutable_points());
  copy(from.types, *to.mutable_types());
  copy(from.connectivity, *to.mutable_connectivity());
  copy(from.offsets, *to.mutable_offsets());
}

void decode(const v1::GridReply& from, Grid& to) {
  to.points.assign(from.points().begin(), from.points().end());
  to.types.assign(from.types().begin(), from.types().end());
  to.connectivity.assign(from.connectivity().begin(), from.connectivity().end());
  to.offsets.assign(from.offsets().begin(), from.offsets().end());
  refuse(FieldPath{nullptr, "grid"}, unsound(to));
}

void encode(const std::vector<FieldValues>& from, v1::FieldsReply& to) {
  to.Clear();
  for (const FieldValues& values : from) copy(values, *to.add_values()->mutable_values());
}

void decode(const v1::FieldsReply& from, const Description& body, std::size_t nodes,
            std::size_t cells, std::vector<FieldValues>& to) {
  to.resize(index(from.values_size()));
  for (std::size_t k = 0; k < to.size(); ++k) {
    const auto& values = from.values(static_cast<int>(k)).values();
    to[k].assign(values.begin(), values.end());
  }
  refuse(FieldPath{nullptr, "fields"}, unsound(to, body.fields, nodes, cells));
}

const char* remedy_of_large_frame(const v1::Request& request) {
  if (request.has_grid() || request.has_fields())
    return "leave out output.fields, take a coarser mesh, or run with --local, which has no frames";
  if (request.has_passive_step())
    return "take a coarser mesh where bodies touch, or run with --local, which has no frames";
  return "use shorter windows or fewer records per window";
}

}  // namespace abut
