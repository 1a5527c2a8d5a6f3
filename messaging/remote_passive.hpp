#pragma once

#include "contract/subdomain.hpp"
#include "messaging/caller.hpp"
#include "messaging/riding_flags.hpp"

namespace abut {

/// The passive form of a body that is elsewhere: one request and one reply per call.
class RemotePassive final : public PassiveForm {
 public:
  /// All three are of the body, and outlive this object.
  RemotePassive(Caller& caller, const Description& body, RidingFlags& flags)
      : caller_(caller), body_(body), flags_(flags) {}

  double enter() override;
  [[nodiscard]] Outcome leave(double time, double& lost) override;
  void start(const PassiveStep& step) override;
  [[nodiscard]] Outcome finish(PassiveReply& reply) override;
  double damp(double joules) override;

 private:
  double energy(double joules, const char* field) const;
  Outcome failed(const v1::Reply& reply, const char* otherwise) const;

  Caller& caller_;
  const Description& body_;
  RidingFlags& flags_;
  const PassiveStep* asked_ = nullptr;  // between start() and finish()
};

}  // namespace abut
