#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "contract/subdomain.hpp"
#include "sdk/served/passive_steps.hpp"
#include "sdk/served/user_body.hpp"

namespace abut {

/// A user's body as the contract has bodies: it takes forces, is probed by trying, and where it has
/// inertia goes through windows passively.
class ServedBody final : public Subdomain {
 public:
  /// `parts` are those of `body`. `alive` is called on the way through windows.
  ServedBody(const abut_body& body, std::unique_ptr<abut_parts> parts, std::function<void()> alive);

  const Description& describe() const override { return description_; }
  void meet(const Meeting&) override {}  // it takes no obstacles
  void save() override { saved_ = user_.snapshot(); }
  void restore() override { user_.return_to(saved_); }
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(const Probing& asked) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  Grid grid() override { return grid_; }
  std::vector<FieldValues> fields() override;
  PassiveForm* passive() override { return description_.can.passive ? &passive_ : nullptr; }

 private:
  void describe_it();
  std::vector<double> ways(const Probing& asked, int count, std::span<const double> force);
  void find_by_trying(const Probing& asked, PortKernel& kernel);

  std::unique_ptr<abut_parts> parts_;
  UserBody user_;
  std::function<void()> alive_;
  Description description_;
  Grid grid_;
  bool draws_ports_;  // the surfaces of its ports, and their motion first
  UserBody::State initial_, saved_;
  const Advance* request_ = nullptr;
  PassiveSteps passive_;
};

}  // namespace abut
