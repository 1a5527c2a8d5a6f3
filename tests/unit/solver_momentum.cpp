// Goal: what is handed in as an impulse arrives, whatever the steps; loads that are known exactly
// move the bar exactly. Oracles: momentum balance, uniform acceleration, rest.

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_momentum_tests {
namespace {

/// A partner's force history over [0, length] at its own steps, of one sign and irregular, and
/// nothing for the last `quiet` seconds.
Waveform partner_force(double length, double quiet, double partner_step, ForceSupport support,
                       double sign) {
  Waveform w;
  w.support = support;
  w.time = substep_times(0.0, length, partner_step);
  for (double t : w.time) {
    const bool pushes = quiet == 0.0 || (t > 0.0 && t < length - quiet);
    w.f.push_back(pushes ? sign * (1.0 + 0.7 * std::sin(5.0 * t) + 0.1 * std::cos(t)) : 0.0);
  }
  return w;
}

/// Schemes that weigh the forces of neighbouring steps hand a part of an impulse over later: their
/// memory fades by a factor of at most 0.73 per step.
bool remembers(const SolverCase& c) {
  return c.name.starts_with("hht") || c.name.starts_with("generalized");
}

struct Ratio {
  double here, partner;  // [s] steps
};

class Impulses : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, Impulses, testing::ValuesIn(complete_cases()), case_name);

TEST_P(Impulses, MomentumGainedIsTheImpulseHandedInForAnyPairOfSteps) {
  const double quiet = remembers(GetParam()) ? 150 * 0.6 : 0.0;  // 0.73^150 is below round-off
  const double length = 1.2 * 6 + quiet;
  for (const Ratio& r : {Ratio{0.6, 0.6}, {0.6, 0.06}, {0.06, 0.6}, {0.4, 0.6}, {0.6, 0.9}}) {
    for (ForceSupport support : {ForceSupport::nodal, ForceSupport::step}) {
      BarText text = case_bar(GetParam(), 0.1);
      const std::size_t at = text.integrator.find(number(case_step));
      ASSERT_NE(at, std::string::npos);
      text.integrator.replace(at, number(case_step).size(), number(r.here));
      const std::unique_ptr<Subdomain> body = build(text);
      Advance request = free_request(*body, 0.0, length);
      double handed = 0.0;
      for (std::size_t p = 0; p < request.boundary.size(); ++p) {
        const double sign = (p == 0 ? -1.0 : -0.4) * outward(*body, p);
        request.boundary[p].forces = {
            partner_force(length, quiet, r.partner, support, sign)};
        double impulse = 0.0;
        request.boundary[p].forces[0].impulse(0.0, length, {&impulse, 1});
        handed += impulse;
      }
      Response response;
      step(*body, request, response);
      // A few roundings of a momentum of 10 kg m/s per node and substep; implicit schemes form
      // velocities out of displacements (of the size u) over a step.
      const double u = std::abs(response.ports[0].trace.u.back()) + 1.0;
      const bool implicit = !GetParam().name.starts_with("explicit");
      const double scale = 10.0 + (implicit ? 40.0 * u / r.here : 0.0);
      EXPECT_NEAR(response.records[0].momentum[0], 4.0 + handed,
                  roundoff(40.0 * response.steps, scale))
          << "steps " << r.here << " here, " << r.partner << " there";
    }
  }
}

TEST_P(Impulses, AnImpulseAtTheBeginIsMomentumAtOnce) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.1));
  Advance request = free_request(*body, 0.0, 6.0);
  request.boundary[0].impulse = {0.25};
  Response response;
  step(*body, request, response);
  EXPECT_NEAR(response.records[0].momentum[0], 4.25, roundoff(400, 4.25));
}

class Loads : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, Loads, testing::ValuesIn(all_cases()), case_name);

TEST_P(Loads, ABodyForceAcceleratesUniformlyAndItsWorkIsTheEnergyGained) {
  const double v0 = 0.3, b = -0.02, t = 12.0;
  BarText text = case_bar(GetParam(), v0);
  text.body_force = b;
  const std::unique_ptr<Subdomain> body = build(text);
  Response start, response;
  step(*body, free_request(*body, 0.0, 0.0), start);
  step(*body, free_request(*body, 0.0, t, 3), response);
  const BodyRecord& end = response.records.back();
  // 20 substeps of a few roundings; implicit solves add the condition of their matrix, below 100
  const double rounding = roundoff(20 * 100, 1.0);
  for (const PortResponse& port : response.ports) {
    const std::vector<double>& times = port.trace.time;
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(port.trace.u[i], v0 * times[i] + 0.5 * b * times[i] * times[i], 10 * rounding);
    EXPECT_NEAR(port.trace.v.back(), v0 + b * t, 100 * rounding);  // differences over a step
  }
  EXPECT_NEAR(end.momentum[0], 40.0 * (v0 + b * t), 40.0 * rounding);
  EXPECT_NEAR(end.energy.stored, 0.0, rounding);
  const double gained = end.energy.total() - start.records[0].energy.total();
  EXPECT_NEAR(gained, end.energy.external_work - start.records[0].energy.external_work,
              40.0 * rounding);
  EXPECT_NEAR(end.energy.external_work, 40.0 * b * (v0 * t + 0.5 * b * t * t), 40.0 * rounding);
}

TEST(Loads, AFixedEndStaysAndTheOtherEndFeelsIt) {
  for (const std::string& scheme :
       {explicit_scheme(0.6), explicit_scheme(0.6, 6), implicit_scheme("newmark", 0.6)}) {
    BarText text = case_bar({"fixed", scheme, "massless: {stiffness_factor: 1.0}", {"right"}});
    text.fixed = "left";
    text.elements = 20;
    text.length = 20.0;
    const std::unique_ptr<Subdomain> body = build(text);
    Advance request = free_request(*body, 0.0, 2000 * 0.6);
    Waveform& force = request.boundary[0].forces.emplace_back();
    force.time = substep_times(0.0, 2000 * 0.6, 0.6);
    force.f.assign(force.time.size(), -0.01);
    Response response;
    step(*body, request, response);
    // A force that appears at once makes the end swing between 0 and twice the static place
    // -F L / (E A) = -0.2 m, to the overshoot of dispersion (below 15 % in all of them).
    double low = 0.0, high = -1.0, mean = 0.0;
    for (double u : response.ports[0].trace.u) {
      low = std::fmin(low, u);
      high = std::fmax(high, u);
      mean += u / static_cast<double>(response.ports[0].trace.size());
    }
    EXPECT_NEAR(low, -0.4, 0.4 * 0.15) << scheme;
    EXPECT_LT(high, 0.4 * 0.15) << scheme;
    EXPECT_NEAR(mean, -0.2, 0.2 * 0.02) << scheme;  // 15 periods of 4 L / c: a part of one is left
  }
}

}  // namespace
}  // namespace abut::solver_momentum_tests
