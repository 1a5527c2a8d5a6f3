#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/subdomain.hpp"
#include "coordinator/record/body_meter.hpp"
#include "coordinator/record/span_file.hpp"

namespace abut {

/// A body, and what it is waited for; a file of spans is told of all that takes time. Entries into
/// its passive form, leaves and damping are counted and not timed.
class MeteredBody final : public Subdomain {
 public:
  /// All must outlive it; `number`: of the body among those of the meter; `spans` may be null.
  MeteredBody(Subdomain& body, std::size_t number, BodyMeter& meter, SpanFile* spans = nullptr)
      : body_(body), number_(number), meter_(meter), spans_(spans), passive_(*this) {}

  const Description& describe() const override { return body_.describe(); }
  void meet(const Meeting& meeting) override;
  void save() override { body_.save(); }
  void restore() override { body_.restore(); }
  void start(const Advance& request) override;
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(const Probing& asked) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  std::vector<double> measure() override;
  Grid grid() override { return body_.grid(); }
  std::vector<FieldValues> fields() override;
  PassiveForm* passive() override;

 private:
  class Passive final : public PassiveForm {
   public:
    explicit Passive(MeteredBody& body) : body_(body) {}
    double enter() override;
    [[nodiscard]] Outcome leave(double time, double& lost) override;
    void start(const PassiveStep& step) override;
    [[nodiscard]] Outcome finish(PassiveReply& reply) override;
    double damp(double joules) override;

   private:
    PassiveForm& form() { return *body_.body_.passive(); }
    MeteredBody& body_;
  };
  /// What a call returns, with a span around it.
  template <class Call>
  auto told(std::string_view what, Call&& call);
  /// What a call returns; where it throws, spans that are open end.
  template <class Call>
  auto heard(Call&& call);

  Subdomain& body_;
  std::size_t number_;
  BodyMeter& meter_;
  SpanFile* spans_;
  Passive passive_;
};

/// All bodies of a run with the meter.
std::vector<std::unique_ptr<Subdomain>> metered(const std::vector<Subdomain*>& bodies,
                                                BodyMeter& meter, SpanFile* spans = nullptr);

}  // namespace abut
