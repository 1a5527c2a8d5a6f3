#include <array>
#include <utility>

#include "base/printable.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

constexpr std::array<std::pair<Failed::Cause, v1::FailureCause>, 4> causes{{
    {Failed::Cause::no_convergence, v1::FAILURE_CAUSE_NO_CONVERGENCE},
    {Failed::Cause::inverted_element, v1::FAILURE_CAUSE_INVERTED_ELEMENT},
    {Failed::Cause::step_too_small, v1::FAILURE_CAUSE_STEP_TOO_SMALL},
    {Failed::Cause::non_finite, v1::FAILURE_CAUSE_NON_FINITE},
}};

}  // namespace

void encode(const Failed& from, v1::Failed& to) {
  to.Clear();
  for (const auto& [ours, wire] : causes) {
    if (ours == from.cause) to.set_cause(wire);
  }
  to.set_time(from.time);
  to.set_detail(from.detail);
}

void decode(const v1::Failed& from, Failed& to) {
  bool known = false;
  for (const auto& [ours, wire] : causes) {
    if (wire != from.cause()) continue;
    to.cause = ours;
    known = true;
  }
  const FieldPath path{nullptr, "failed"};
  if (!known) FieldPath{&path, "cause"}.fail("has an unknown value");
  to.time = from.time();  // may be anything: it is the report of a failure
  to.detail = printable(from.detail());
}

}  // namespace abut
