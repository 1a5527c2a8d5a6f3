#include "messaging/remote_passive.hpp"

#include "messaging/codec.hpp"
#include "messaging/soundness.hpp"

namespace abut {

double RemotePassive::enter() {
  caller_.request().mutable_passive_enter();
  flags_.ride(caller_.request());
  const v1::Reply& reply = caller_.call("passive enter");
  if (!reply.has_passive_entered()) caller_.refuse_reply("not an entry into the passive form");
  return energy(reply.passive_entered().lost(), "passive_entered.lost");
}

Outcome RemotePassive::leave(double time, double& lost) {
  caller_.request().mutable_passive_leave()->set_time(time);
  flags_.ride(caller_.request());
  const v1::Reply& reply = caller_.call("passive leave");
  if (!reply.has_passive_left()) return failed(reply, "not a leave from the passive form");
  lost = energy(reply.passive_left().lost(), "passive_left.lost");
  return Advanced{};
}

void RemotePassive::start(const PassiveStep& step) {
  asked_ = &step;
  flags_.ride(caller_.request());
  caller_.post(step);
}

Outcome RemotePassive::finish(PassiveReply& reply) {
  const v1::Reply& wire = caller_.await();
  if (!wire.has_passive_stepped()) return failed(wire, "not a passive step");
  try {
    decode(caller_.bulk(), body_, *asked_, reply);
    require_sound(reply, body_, *asked_);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  return Advanced{};
}

double RemotePassive::damp(double joules) {
  caller_.request().mutable_passive_damp()->set_joules(joules);
  flags_.ride(caller_.request());
  const v1::Reply& reply = caller_.call("passive damp");
  if (!reply.has_passive_damped()) caller_.refuse_reply("not a damping of the passive form");
  return energy(reply.passive_damped().taken(), "passive_damped.taken");
}

double RemotePassive::energy(double joules, const char* field) const {
  try {
    return number(joules, FieldPath{nullptr, field});
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
}

/// The failure that the reply tells; any other kind of reply is refused.
Outcome RemotePassive::failed(const v1::Reply& reply, const char* otherwise) const {
  if (!reply.has_failed()) caller_.refuse_reply(otherwise);
  Failed failed;
  try {
    decode(reply.failed(), failed);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  return failed;
}

}  // namespace abut
