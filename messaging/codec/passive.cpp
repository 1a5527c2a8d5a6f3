#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(PassiveStep) == 3 * sizeof(double) + 2 * sizeof(std::vector<double>));
static_assert(sizeof(PassiveReply::Port) == 2 * sizeof(std::vector<double>));
static_assert(sizeof(PassiveReply) ==
              2 * sizeof(std::vector<double>) + sizeof(BodyRecord) + 3 * sizeof(double));

using Step = v1::PassiveStep;
using Stepped = v1::PassiveStepped;

void decode_push(Bytes bytes, const SurfaceSize& port, const FieldPath& path,
                 std::vector<double>& impulse, std::vector<std::int32_t>& pressed) {
  impulse.clear();
  pressed.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::PassivePush::kImpulseFieldNumber:
        from.numbers(impulse);
        break;
      case v1::PassivePush::kPressedFieldNumber:
        from.integers(pressed);
        break;
      default:
        from.skip();
    }
  }
  check(impulse, index(port.width()), true, FieldPath{&path, "impulse"});
  check_points(pressed, port.points, FieldPath{&path, "pressed"});
}

void decode_place(Bytes bytes, const SurfaceSize& port, const FieldPath& path,
                  PassiveReply::Port& to) {
  to.displacement.clear();
  to.velocity.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::PassivePlace::kDisplacementFieldNumber:
        from.numbers(to.displacement);
        break;
      case v1::PassivePlace::kVelocityFieldNumber:
        from.numbers(to.velocity);
        break;
      default:
        from.skip();
    }
  }
  check(to.displacement, index(port.width()), false, FieldPath{&path, "displacement"});
  check(to.velocity, index(port.width()), false, FieldPath{&path, "velocity"});
}

std::int32_t decode_looser(std::int64_t value, const FieldPath& path) {
  if (value < 0 || value > PassiveStep::loosest)
    path.fail(fmt::format("is {}, not within 0 and {}", value, PassiveStep::loosest));
  return static_cast<std::int32_t>(value);
}

}  // namespace

std::size_t pressed_values(const PassiveStep& asked, const Description& body) {
  std::size_t points = 0;
  for (const std::vector<std::int32_t>& of_port : asked.pressed) points += of_port.size();
  return points * index(body.dim);
}

void encode(const PassiveStep& from, WireWriter& to) {
  ABUT_ASSERT(from.impulses.size() == from.pressed.size());
  for (std::size_t p = from.impulses.size(); p-- > 0;) {
    const std::size_t before = to.size();
    to.integers(v1::PassivePush::kPressedFieldNumber, from.pressed[p]);
    to.numbers(v1::PassivePush::kImpulseFieldNumber, from.impulses[p]);
    to.close(Step::kPortsFieldNumber, before);
  }
  to.integer(Step::kAgainFieldNumber, from.again ? 1 : 0);
  to.integer(Step::kLooserFieldNumber, from.looser);
  to.number(Step::kEndFieldNumber, from.end);
  to.number(Step::kBeginFieldNumber, from.begin);
}

void decode(Bytes bytes, const Description& body, PassiveStep& to) {
  const FieldPath path{nullptr, "passive_step"};
  const FieldPath all_ports{&path, "ports"};
  to.begin = to.end = 0.0;
  to.looser = 0;
  to.again = false;
  to.impulses.resize(body.ports.size());
  to.pressed.resize(body.ports.size());
  std::size_t ports = 0;
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case Step::kBeginFieldNumber:
        to.begin = number(from.number(), FieldPath{&path, "begin"});
        break;
      case Step::kEndFieldNumber:
        to.end = number(from.number(), FieldPath{&path, "end"});
        break;
      case Step::kLooserFieldNumber:
        to.looser = decode_looser(from.integer(), FieldPath{&path, "looser"});
        break;
      case Step::kAgainFieldNumber:
        to.again = from.integer() != 0;
        break;
      case Step::kPortsFieldNumber:
        if (ports >= body.ports.size()) {
          all_ports.fail(fmt::format("has more entries than the body's {} ports", ports));
        }
        decode_push(from.message(), size_of(body.ports[ports].geometry),
                    FieldPath{&path, "ports", static_cast<int>(ports)}, to.impulses[ports],
                    to.pressed[ports]);
        ++ports;
        break;
      default:
        from.skip();
    }
  }
  require_count(ports, body.ports.size(), "ports", all_ports);
  if (!(to.end >= to.begin)) path.fail(fmt::format("is from {} to {} s", to.begin, to.end));
}

void encode(const PassiveReply& from, WireWriter& to) {
  to.number(Stepped::kComputeSecondsFieldNumber, from.compute_seconds);
  to.number(Stepped::kHeldFieldNumber, from.held);
  to.number(Stepped::kBulgeFieldNumber, from.bulge);
  const std::size_t before_record = to.size();
  encode(from.record, to);
  to.close(Stepped::kRecordFieldNumber, before_record);
  to.numbers(Stepped::kComplianceFieldNumber, from.compliance);
  for (std::size_t p = from.ports.size(); p-- > 0;) {
    const std::size_t before = to.size();
    to.numbers(v1::PassivePlace::kVelocityFieldNumber, from.ports[p].velocity);
    to.numbers(v1::PassivePlace::kDisplacementFieldNumber, from.ports[p].displacement);
    to.close(Stepped::kPortsFieldNumber, before);
  }
}

void decode(Bytes bytes, const Description& body, const PassiveStep& asked, PassiveReply& to) {
  const FieldPath path{nullptr, "passive_stepped"};
  const FieldPath all_ports{&path, "ports"}, record{&path, "record"};
  to.ports.resize(body.ports.size());
  to.bulge = to.held = to.compute_seconds = 0.0;
  std::size_t ports = 0;
  bool recorded = false, compliant = false;
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case Stepped::kPortsFieldNumber:
        if (ports >= body.ports.size()) {
          all_ports.fail(fmt::format("has more entries than the body's {} ports", ports));
        }
        decode_place(from.message(), size_of(body.ports[ports].geometry),
                     FieldPath{&path, "ports", static_cast<int>(ports)}, to.ports[ports]);
        ++ports;
        break;
      case Stepped::kComplianceFieldNumber:
        from.numbers(to.compliance, compliant);
        break;
      case Stepped::kRecordFieldNumber:
        decode(from.message(), body, record, to.record);
        recorded = true;
        break;
      case Stepped::kBulgeFieldNumber:
        to.bulge = number(from.number(), FieldPath{&path, "bulge"}, Allow::not_negative);
        break;
      case Stepped::kHeldFieldNumber:
        to.held = number(from.number(), FieldPath{&path, "held"}, Allow::not_negative);
        break;
      case Stepped::kComputeSecondsFieldNumber:
        to.compute_seconds =
            number(from.number(), FieldPath{&path, "compute_seconds"}, Allow::not_negative);
        break;
      default:
        from.skip();
    }
  }
  require_count(ports, body.ports.size(), "ports", all_ports);
  if (!recorded) record.fail("is missing");
  if (!compliant) to.compliance.clear();
  const std::size_t values = pressed_values(asked, body);
  check(to.compliance, to.bounds(values) ? values : values * values, false,
        FieldPath{&path, "compliance"});
}

}  // namespace abut
