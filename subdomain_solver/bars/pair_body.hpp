#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/subdomain.hpp"
#include "subdomain_solver/bars/pair_integrator.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// A subdomain of two bars whose contact is its own affair: the conventional contact methods, which
/// are monolithic. Its members `left` and `right` are recorded as if they were bodies; its ports
/// `left_tip` and `right_tip` show the contact and take nothing.
class PairBody final : public Subdomain {
 public:
  struct Parameters {
    std::array<BarProperties, 2> bars;  // left, right
    ElementLengths lengths = ElementLengths::reference;
    PairContact contact;
    double step = 0.0;                   // [s]
    std::optional<StepWeights> weights;  // absent: central difference
    std::string words;                   // for people
  };

  PairBody(std::string name, const Parameters& parameters);

  const Description& describe() const override { return description_; }
  void meet(int, const PortGeometry&, const ContactLaw&) override {}  // takes no obstacles
  void yields(int, int, const PortKernel&) override {}
  void save() override;
  void restore() override;
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  /// Not offered: RunError.
  PortKernel probe(int port, std::span<const double> patterns, double step, int count) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

  /// Called now and then during a long advance.
  void set_progress(std::function<void()> hook) { progress_ = std::move(hook); }

 private:
  void describe_members(const Parameters& parameters);
  std::optional<Failed> advance_window(const Advance& request, const Substeps& grid,
                                       Response& response);
  void push_traces(const Advance& request, double time, Response& response) const;
  void sweep();
  std::optional<Failed> record(double time, Response& response);
  void report_progress();

  Description description_;
  BarPair pair_;
  PairState state_;
  std::unique_ptr<PairIntegrator> integrator_;
  std::array<double, 2> low_{}, high_{};  // [m] range of the tips since the last record
  const Advance* request_ = nullptr;
  std::vector<std::byte> saved_;
  std::function<void()> progress_;
  double work_since_progress_ = 0.0;  // element-steps
};

}  // namespace abut
