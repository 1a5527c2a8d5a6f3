#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contract/subdomain.hpp"
#include "coordinator/record/body_meter.hpp"

namespace abut {

/// A body, and what it is waited for. Steps of its passive form are not told of.
class MeteredBody final : public Subdomain {
 public:
  /// Both must outlive it; `number`: of the body among those of the meter.
  MeteredBody(Subdomain& body, std::size_t number, BodyMeter& meter)
      : body_(body), number_(number), meter_(meter) {}

  const Description& describe() const override { return body_.describe(); }
  void meet(const Meeting& meeting) override { body_.meet(meeting); }
  void save() override { body_.save(); }
  void restore() override { body_.restore(); }
  void start(const Advance& request) override;
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(const Probing& asked) override;
  std::vector<std::byte> checkpoint() override { return body_.checkpoint(); }
  void resume(std::span<const std::byte> bytes) override { body_.resume(bytes); }
  std::uint64_t state_hash() override { return body_.state_hash(); }
  std::vector<double> measure() override { return body_.measure(); }
  Grid grid() override { return body_.grid(); }
  std::vector<FieldValues> fields() override { return body_.fields(); }
  PassiveForm* passive() override { return body_.passive(); }

 private:
  Subdomain& body_;
  std::size_t number_;
  BodyMeter& meter_;
};

/// All bodies of a run with the meter.
std::vector<std::unique_ptr<Subdomain>> metered(const std::vector<Subdomain*>& bodies,
                                                BodyMeter& meter);

}  // namespace abut
