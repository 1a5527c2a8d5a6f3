#pragma once

#include <memory>

#include "subdomain_solver/time/foreseeing.hpp"
#include "subdomain_solver/time/frequency_watch.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Explicit steps that are held below their stable limit while the body deforms [M.59]. Now and
/// then a bound on the highest frequency is found; between two bounds its growth is carried on from
/// that between the last two, an estimate. Above the limit a step is refused, or taken in equal
/// parts until whole ones are stable again.
class StableSteps final : public Integrator, private Foreseeing {
 public:
  struct Options {
    double step = 0.0;   // [s] the whole step
    double limit = 0.0;  // [s] stable limit at the begin, at least the step
    bool clamp = false;  // parts instead of a refusal
  };
  /// `steps`: the explicit scheme itself.
  StableSteps(std::unique_ptr<Integrator> steps, std::unique_ptr<FrequencyWatch> watch,
              const Options& options);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double time, double step, const Vector& external,
                    Vector& out) const override {
    steps_->acceleration(motion, time, step, external, out);
  }
  double kinetic(const Motion& motion) const override { return steps_->kinetic(motion); }
  /// stable_step.min [s], of all bounds so far; stable_step.parts, the most of a step.
  static std::vector<std::string> measure_names();
  std::vector<double> measure(const Motion& motion) const;

 private:
  struct Control;
  Abilities abilities(const Integrator& steps);
  /// A whole step, as the explicit scheme tells it; where a bound is due only a step tells.
  bool foresee(const Motion& motion, double time, double dt, Foreseen& ahead) override;
  bool is_due(const Motion& motion, const Control& control) const;
  double parts_of(double dt, const Control& control) const;
  [[nodiscard]] std::optional<Failed> check(Motion& motion, double time);
  [[nodiscard]] std::optional<Failed> decide(const Motion& motion, double time, double& square);
  double square_of(double parts) const;
  void divide(Control& control, bool whole_is_stable) const;
  void set_interval(Control& control, double square) const;

  std::unique_ptr<FrequencyWatch> watch_;
  Options options_;
  std::unique_ptr<Integrator> steps_;
  Motion before_;  // a step of several parts
  std::vector<double> control_;  // a copy of a motion's
};

}  // namespace abut
