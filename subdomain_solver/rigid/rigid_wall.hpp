#pragma once

#include "contract/subdomain.hpp"

namespace abut {

/// An immovable rigid surface: takes any force and never moves. Has no step of its own.
class RigidWall final : public Subdomain {
 public:
  RigidWall(std::string name, double position, std::string port, double normal);

  const Description& describe() const override { return description_; }
  void meet(int, const PortGeometry&, const ContactLaw&) override {}  // takes no obstacles
  void yields(int, int, const PortKernel&) override {}
  void save() override {}
  void restore() override {}
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(int port, std::span<const double> patterns, double step, int count) override;
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }
  Grid grid() override;  // the port's point
  std::vector<FieldValues> fields() override;

 private:
  Description description_;
  const Advance* request_ = nullptr;
};

}  // namespace abut
