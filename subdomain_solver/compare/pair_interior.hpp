#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "subdomain_solver/compare/pair_integrator.hpp"
#include "subdomain_solver/interior.hpp"

namespace abut {

/// Two bars whose contact is its own affair: the conventional contact methods, which
/// are monolithic. Its members `left` and `right` are recorded as if they were bodies; its ports
/// `left_tip` and `right_tip` show the contact and take nothing.
class PairInterior final : public Interior {
 public:
  struct Parameters {
    std::array<BarProperties, 2> bars;  // left, right
    ElementLengths lengths = ElementLengths::reference;
    PairContact contact;
    double step = 0.0;                   // [s]
    std::optional<StepWeights> weights;  // absent: central difference
    std::string words;                   // for people
  };

  PairInterior(std::string name, const Parameters& parameters);

  void state(Archive& archive) override { state_.state(archive); }
  std::size_t coordinates() const override;
  void restored() override { pair_.follow(state_.u); }
  std::optional<Failed> step(const Window& window, int i, bool whole) override;
  const PortValues& see(const Window& window, double time, bool all) override;
  std::optional<Failed> record(BodyRecord& record) override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

 private:
  void describe_members(const Parameters& parameters);

  BarPair pair_;
  PairState state_;
  std::unique_ptr<PairIntegrator> integrator_;
  PortValues seen_;
};

}  // namespace abut
