#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Energy) == 4 * sizeof(double));
static_assert(sizeof(BodyRecord) ==
              sizeof(Energy) + sizeof(double) + 4 * sizeof(std::vector<double>));
static_assert(sizeof(MemberRecord) == sizeof(Energy) + sizeof(std::vector<double>));

/// Of a body's record or a member's: both have the same fields.
template <class Wire>
void encode_energy(const Energy& from, Wire& to) {
  to.set_kinetic(from.kinetic);
  to.set_stored(from.stored);
  to.set_dissipated(from.dissipated);
  to.set_external_work(from.external_work);
}

template <class Wire>
Energy decode_energy(const Wire& from, const FieldPath& path) {
  return Energy{.kinetic = number(from.kinetic(), FieldPath{&path, "kinetic"}),
                .stored = number(from.stored(), FieldPath{&path, "stored"}),
                .dissipated = number(from.dissipated(), FieldPath{&path, "dissipated"}),
                .external_work = number(from.external_work(), FieldPath{&path, "external_work"})};
}

}  // namespace

void encode(const BodyRecord& from, v1::BodyRecord& to) {
  to.set_time(from.time);
  encode_energy(from.energy, to);
  copy(from.momentum, *to.mutable_momentum());
  copy(from.angular_momentum, *to.mutable_angular_momentum());
  copy(from.columns, *to.mutable_columns());
  resize(*to.mutable_members(), from.members.size());
  for (std::size_t m = 0; m < from.members.size(); ++m) {
    v1::MemberRecord& member = *to.mutable_members(static_cast<int>(m));
    encode_energy(from.members[m].energy, member);
    copy(from.members[m].momentum, *member.mutable_momentum());
  }
}

void decode(const v1::BodyRecord& from, const Description& body, const FieldPath& path,
            BodyRecord& to) {
  const std::size_t dim = index(body.dim);
  to.time = number(from.time(), FieldPath{&path, "time"});
  to.energy = decode_energy(from, path);
  take(from.momentum(), dim, true, FieldPath{&path, "momentum"}, to.momentum);
  take(from.angular_momentum(), dim < 3 ? dim - 1 : dim, true, FieldPath{&path, "angular_momentum"},
       to.angular_momentum);
  take(from.columns(), body.columns.size(), false, FieldPath{&path, "columns"}, to.columns);
  require_count(from.members_size(), body.members.size(), "members", FieldPath{&path, "members"});
  to.members.resize(body.members.size());
  for (std::size_t i = 0; i < to.members.size(); ++i) {
    const v1::MemberRecord& wire = from.members(static_cast<int>(i));
    const FieldPath member{&path, "members", static_cast<int>(i)};
    to.members[i].energy = decode_energy(wire, member);
    take(wire.momentum(), dim, true, FieldPath{&member, "momentum"}, to.members[i].momentum);
  }
}

}  // namespace abut
