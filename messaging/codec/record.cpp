#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Energy) == 4 * sizeof(double));
static_assert(sizeof(BodyRecord) ==
              sizeof(Energy) + sizeof(double) + 4 * sizeof(std::vector<double>));
static_assert(sizeof(MemberRecord) == sizeof(Energy) + sizeof(std::vector<double>));

using WireRecord = v1::BodyRecord;
using MemberWire = v1::MemberRecord;

// Both kinds of record have the same energies; their fields differ in number.
struct EnergyFields {
  int kinetic, stored, dissipated, external_work;
};
constexpr EnergyFields of_body{WireRecord::kKineticFieldNumber, WireRecord::kStoredFieldNumber,
                               WireRecord::kDissipatedFieldNumber,
                               WireRecord::kExternalWorkFieldNumber};
constexpr EnergyFields of_member{MemberWire::kKineticFieldNumber, MemberWire::kStoredFieldNumber,
                                 MemberWire::kDissipatedFieldNumber,
                                 MemberWire::kExternalWorkFieldNumber};

void encode(const Energy& from, const EnergyFields& fields, WireWriter& to) {
  to.number(fields.external_work, from.external_work);
  to.number(fields.dissipated, from.dissipated);
  to.number(fields.stored, from.stored);
  to.number(fields.kinetic, from.kinetic);
}

/// False where the present field is none of them.
bool read(WireReader& from, const EnergyFields& fields, const FieldPath& path, Energy& to) {
  const int field = from.field();
  if (field == fields.kinetic) {
    to.kinetic = number(from.number(), FieldPath{&path, "kinetic"});
  } else if (field == fields.stored) {
    to.stored = number(from.number(), FieldPath{&path, "stored"});
  } else if (field == fields.dissipated) {
    to.dissipated = number(from.number(), FieldPath{&path, "dissipated"});
  } else if (field == fields.external_work) {
    to.external_work = number(from.number(), FieldPath{&path, "external_work"});
  } else {
    return false;
  }
  return true;
}

void decode_member(Bytes bytes, std::size_t dim, const FieldPath& path, MemberRecord& to) {
  to.energy = {};
  to.momentum.clear();
  for (WireReader from(bytes, path); from.next();) {
    if (read(from, of_member, path, to.energy)) continue;
    if (from.field() == MemberWire::kMomentumFieldNumber) {
      from.numbers(to.momentum);
    } else {
      from.skip();
    }
  }
  check(to.momentum, dim, true, FieldPath{&path, "momentum"});
}

}  // namespace

void encode(const BodyRecord& from, WireWriter& to) {
  to.numbers(WireRecord::kColumnsFieldNumber, from.columns);
  to.numbers(WireRecord::kAngularMomentumFieldNumber, from.angular_momentum);
  for (std::size_t m = from.members.size(); m-- > 0;) {
    const std::size_t before = to.size();
    to.numbers(MemberWire::kMomentumFieldNumber, from.members[m].momentum);
    encode(from.members[m].energy, of_member, to);
    to.close(WireRecord::kMembersFieldNumber, before);
  }
  to.numbers(WireRecord::kMomentumFieldNumber, from.momentum);
  encode(from.energy, of_body, to);
  to.number(WireRecord::kTimeFieldNumber, from.time);
}

void decode(Bytes bytes, const Description& body, const FieldPath& path, BodyRecord& to) {
  const std::size_t dim = index(body.dim);
  const FieldPath all_members{&path, "members"};
  to.time = 0.0;
  to.energy = {};
  to.momentum.clear();
  to.angular_momentum.clear();
  to.columns.clear();
  to.members.resize(body.members.size());
  std::size_t members = 0;
  for (WireReader from(bytes, path); from.next();) {
    if (read(from, of_body, path, to.energy)) continue;
    switch (from.field()) {
      case WireRecord::kTimeFieldNumber:
        to.time = number(from.number(), FieldPath{&path, "time"});
        break;
      case WireRecord::kMomentumFieldNumber:
        from.numbers(to.momentum);
        break;
      case WireRecord::kAngularMomentumFieldNumber:
        from.numbers(to.angular_momentum);
        break;
      case WireRecord::kColumnsFieldNumber:
        from.numbers(to.columns);
        break;
      case WireRecord::kMembersFieldNumber:
        if (members >= to.members.size()) {
          all_members.fail(fmt::format("has more entries than the body's {} members", members));
        }
        decode_member(from.message(), dim, FieldPath{&path, "members", static_cast<int>(members)},
                      to.members[members]);
        ++members;
        break;
      default:
        from.skip();
    }
  }
  require_count(members, body.members.size(), "members", all_members);
  check(to.momentum, dim, true, FieldPath{&path, "momentum"});
  check(to.angular_momentum, dim < 3 ? dim - 1 : dim, true, FieldPath{&path, "angular_momentum"});
  check(to.columns, body.columns.size(), false, FieldPath{&path, "columns"});
}

}  // namespace abut
