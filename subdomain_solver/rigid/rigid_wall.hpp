#pragma once

#include <string>

#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/passive/passive_body.hpp"

namespace abut {

/// An immovable rigid surface: takes any force and never moves. Has no step of its own.
class RigidWall final : public Interior, private Probed, private PassiveBody {
 public:
  RigidWall(std::string name, double position, std::string port, double normal);

  void state(Archive&) override {}
  std::size_t coordinates() const override { return 0; }
  std::optional<Failed> step(const Window&, int, bool) override { return std::nullopt; }
  const PortValues& see(const Window& window, double time, bool all) override;
  std::optional<Failed> record(BodyRecord& record) override;
  void finish(std::size_t port, PortResponse& reply) const override;
  Grid grid() override;  // the port's point
  std::vector<FieldValues> fields() override;

 private:
  double compliance(std::size_t) const override { return 0.0; }
  double light_force(std::size_t) const override { return 1.0; }
  bool rest(std::size_t) override { return false; }
  void wake() override {}

  // Nothing it has is other in its passive form.
  double enter() override { return 0.0; }
  std::optional<Failed> leave(double, double& lost) override;
  double damp(double) override { return 0.0; }
  std::optional<Failed> pass(const PassiveStep& step, PassiveReply& reply) override;

  PortValues seen_;
};

}  // namespace abut
