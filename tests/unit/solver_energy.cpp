// Goal: what each scheme conserves stays for ever, what is said to dissipate dissipates, and errors
// fall with the orders and the dispersion that theory gives.
// Oracles: the schemes' invariants, vibration modes, closed dispersion relations.

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/bars/central_difference.hpp"
#include "subdomain_solver/bars/generalized_alpha.hpp"
#include "tests/support/oracles.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_energy_tests {
namespace {

constexpr double pi = std::numbers::pi;

/// A free bar of wave speed, density and area 1, and a scheme on it.
struct Vibration {
  Bar bar;
  std::unique_ptr<BarIntegrator> scheme;
  double dt;
  BarState state;

  Vibration(int elements, double length, MassForm mass, double step)
      : bar(data(elements, length, mass)), dt(step) {
    const std::size_t n = index(bar.nodes());
    state.u.assign(n, 0.0);
    state.v.assign(n, 0.0);
    state.a.assign(n, 0.0);
  }
  static BarProperties data(int elements, double length, MassForm mass) {
    BarProperties d;
    d.length = length;
    d.area = d.youngs_modulus = d.density = 1.0;
    d.elements = elements;
    d.mass = mass;
    return d;
  }
  void explicit_terms(int terms) { scheme = std::make_unique<CentralDifference>(bar, dt, terms); }
  void weights(const AlphaWeights& w) { scheme = std::make_unique<GeneralizedAlpha>(bar, w, dt); }

  /// u = cos(k x), the exact discrete mode with k = mode pi / length, at rest; the acceleration
  /// belongs to it.
  void start_mode(int mode) {
    const std::size_t n = state.u.size();
    std::vector<double> force;
    for (std::size_t i = 0; i < n; ++i)
      state.u[i] = std::cos(mode * pi * static_cast<double>(i) / static_cast<double>(n - 1));
    bar.internal_force(state.u, force);
    const double stiff = force[0] / state.u[0];  // end rows: half an element's mass and stiffness
    const double b = bar.mass_beside()[0] / bar.element_mass();
    const double m = bar.element_mass() * (0.5 - b + b * state.u[1] / state.u[0]);
    for (std::size_t i = 0; i < n; ++i) state.a[i] = -stiff / m * state.u[i];
  }
  void run(int steps) {
    scheme->open(state, dt, {});
    for (int i = 0; i < steps; ++i) scheme->substep(state, dt, {});
    scheme->close(state, dt);
  }
  double energy() const { return scheme->kinetic(state) + scheme->stored(state); }

  /// Angular frequency of the mode out of its periods up to the time `until`: linear crossings of
  /// zero between steps, from the first to the last.
  double frequency(double until) {
    double first = -1.0, last = 0.0;
    int halves = -1;
    double before = state.u[0];
    scheme->open(state, dt, {});
    for (int i = 1; i * dt <= until; ++i) {
      scheme->substep(state, dt, {});
      if ((before > 0.0) != (state.u[0] > 0.0)) {
        last = dt * (i - 1 + before / (before - state.u[0]));
        if (first < 0.0) first = last;
        ++halves;
      }
      before = state.u[0];
    }
    scheme->close(state, dt);
    return pi * halves / (last - first);
  }
};

/// Velocities of two step fronts without a mean: every mode takes part, and the bar stays near its
/// place.
void strike(Vibration& v) {
  const std::size_t n = v.state.v.size();
  for (std::size_t i = 0; i < n / 3; ++i) {
    v.state.v[i] = 1.0;
    v.state.v[n - 1 - i] = -1.0;
  }
}

TEST(Energy, CentralDifferenceKeepsItsInvariantFor100000Steps) {
  for (int terms : {1, 6}) {
    for (double cfl : {0.5, 0.99}) {
      Vibration v(30, 30.0, MassForm::lumped, cfl);
      v.explicit_terms(terms);
      strike(v);
      v.run(1);
      const double before = v.energy();
      v.run(100000);
      // Roundings of 1e5 steps, if they all had one sign; the invariant's terms are up to
      // 1 / sqrt(1 - cfl^2) = 7 times its own size.
      EXPECT_NEAR(v.energy(), before, roundoff(1e5 * 7, before)) << terms << " terms, CFL " << cfl;
    }
  }
}

TEST(Energy, TheTrapezoidalRuleKeepsItsEnergyFor100000Steps) {
  for (MassForm mass : {MassForm::lumped, MassForm::averaged, MassForm::consistent}) {
    Vibration v(30, 30.0, mass, 1.0);
    v.weights(AlphaWeights::newmark(0.25, 0.5));
    strike(v);
    v.run(1);
    const double before = v.energy();
    v.run(100000);
    // Displacements stay below 10 m; a step rounds them to form velocities of 1 m/s.
    EXPECT_NEAR(v.energy(), before, roundoff(1e5 * 10, before));
  }
}

TEST(Energy, DissipativeSchemesLoseHighModesAndNeverGain) {
  for (const AlphaWeights& w : {AlphaWeights::hht(-0.1), AlphaWeights::spectral_radius(0.8)}) {
    Vibration low(30, 30.0, MassForm::averaged, 1.0);
    low.weights(w);
    low.start_mode(1);
    const double before = low.energy();
    low.run(600);
    EXPECT_LT(low.energy(), before);
    EXPECT_GT(low.energy(), 0.97 * before);  // 10 periods of 60 steps: w dt = 0.1
    Vibration high(30, 30.0, MassForm::averaged, 4.0);
    high.weights(w);
    high.start_mode(25);
    const double start = high.energy();
    high.run(300);
    EXPECT_LT(high.energy(), std::pow(0.95, 2 * 300) * start);  // amplitudes at w dt of 7 and more
  }
}

TEST(Energy, ASpectralRadiusOfOneDissipatesNothing) {
  Vibration v(30, 30.0, MassForm::lumped, 1.0);
  v.weights(AlphaWeights::spectral_radius(1.0));
  v.start_mode(3);
  v.run(1);
  const double before = v.energy();
  v.run(3000);
  // Energy of the midpoint rule wobbles within a period and does not drift: compare after whole
  // periods to the square of w dt = 0.31.
  EXPECT_NEAR(v.energy(), before, 0.1 * before);
}

/// Error of the mode's displacement at a fixed time, by step.
double error_in_time(int steps, const std::function<void(Vibration&)>& choose) {
  const double until = 10.0;
  Vibration v(10, 10.0, MassForm::lumped, until / steps);
  choose(v);
  v.start_mode(2);
  v.run(steps);
  const double k = 2 * pi / 10.0;
  const double w = 2.0 * std::sin(0.5 * k);  // of the space-discrete mode
  return v.state.u[0] - std::cos(w * until);
}

TEST(Order, EveryIntegratorIsOfSecondOrderInTime) {
  const std::vector<std::function<void(Vibration&)>> schemes = {
      [](Vibration& v) { v.explicit_terms(1); },
      [](Vibration& v) { v.weights(AlphaWeights::newmark(0.25, 0.5)); },
      [](Vibration& v) { v.weights(AlphaWeights::hht(-0.1)); },
      [](Vibration& v) { v.weights(AlphaWeights::spectral_radius(0.5)); }};
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    const double e1 = error_in_time(80, schemes[s]);
    const double e2 = error_in_time(160, schemes[s]);
    const double e3 = error_in_time(320, schemes[s]);
    // the next term of the error is two powers further, or one with dissipation: 5 % at these steps
    EXPECT_NEAR(observed_order(e1, e2), 2.0, 0.1) << s;
    EXPECT_NEAR(observed_order(e2, e3), 2.0, 0.1) << s;
  }
}

/// Relative error of the first mode's frequency, time steps so small that space decides.
double error_in_space(int elements, MassForm mass, int terms) {
  const double dt = terms > 0 ? 0.02 / elements : 0.01 / elements;
  Vibration v(elements, 1.0, mass, dt);
  if (terms > 0) v.explicit_terms(terms);
  if (terms == 0) v.weights(AlphaWeights::newmark(0.25, 0.5));
  const double b = mass == MassForm::averaged ? 1.0 / 12.0 : 0.0;
  const double half = 0.5 * pi / elements;
  // closed form of the space-discrete frequency, against the measured one
  const double s = std::sin(half);
  const double closed = s / half / std::sqrt(1.0 - 4.0 * b * s * s);
  v.start_mode(1);
  const double measured = v.frequency(6.0) / pi;
  // the time error is below (w dt)^2 / 12 of it: 1e-5 of the error in space for P = 1
  if (terms <= 1) {
    EXPECT_NEAR(measured, closed, 2e-5) << elements;
  }
  return measured - 1.0;
}

TEST(Order, PlainBarIsOfSecondOrderInSpace) {
  const double e1 = error_in_space(4, MassForm::lumped, 1);
  const double e2 = error_in_space(8, MassForm::lumped, 1);
  const double e3 = error_in_space(16, MassForm::lumped, 1);
  EXPECT_NEAR(observed_order(e1, e2), 2.0, 0.05);  // next term: h^4, 2 % at 4 elements
  EXPECT_NEAR(observed_order(e2, e3), 2.0, 0.05);
}

TEST(Order, AveragedMassIsOfFourthOrderInSpace) {
  const double e1 = error_in_space(3, MassForm::averaged, 0);
  const double e2 = error_in_space(6, MassForm::averaged, 0);
  EXPECT_NEAR(observed_order(e1, e2), 4.0, 0.4);  // the error of the time step shows beyond
}

/// Frequency over the exact one of a wave of `elements` per length at CFL r.
double measured_phase_speed(int elements, double r, MassForm mass, bool implicit) {
  // A free bar of half a wavelength holds the wave as its first mode; periods are counted as
  // steps: a linear crossing of a cosine between steps is exact over whole periods on average.
  const int half = elements / 2;
  Vibration v(half, half, mass, r);
  if (implicit) {
    v.weights(AlphaWeights::newmark(0.25, 0.5));
  } else {
    v.explicit_terms(1);
  }
  v.start_mode(1);
  return v.frequency(4000.0 * elements) / (2.0 * pi / elements);
}

// 4000 periods; a linear crossing is wrong by at most a hundredth of a period at 10 steps each.
constexpr double counting = 0.01 / 4000;

TEST(Dispersion, CentralDifferenceHasTheTabulatedPhaseSpeed) {
  struct Row {
    int elements;
    double cfl, speed;
  };
  for (const Row& row : {Row{10, .1, .98379},
                         {10, .5, .98759},
                         {10, .9, .99677},
                         {10, 1.0, 1.0},
                         {20, .1, .99593},
                         {20, .5, .99691},
                         {20, .9, .99921},
                         {20, 1.0, 1.0}}) {
    const double closed = phase_speed_lumped_explicit(row.elements, row.cfl);
    EXPECT_NEAR(closed, row.speed, 5e-6);  // the table's digits
    EXPECT_NEAR(measured_phase_speed(row.elements, row.cfl, MassForm::lumped, false), closed,
                counting)
        << row.elements << " elements, CFL " << row.cfl;
  }
}

TEST(Dispersion, TheTrapezoidalRuleHasTheTabulatedPhaseSpeed) {
  struct Row {
    int elements;
    MassForm mass;
    double b, speed;
  };
  for (const Row& row : {Row{10, MassForm::lumped, 0.0, .95400},
                         {20, MassForm::lumped, 0.0, .98789},
                         {10, MassForm::consistent, 1.0 / 6.0, .98394},
                         {20, MassForm::consistent, 1.0 / 6.0, .99591}}) {
    const double closed = phase_speed_trapezoidal(row.elements, 1.0, row.b);
    EXPECT_NEAR(closed, row.speed, 5e-6);
    EXPECT_NEAR(measured_phase_speed(row.elements, 1.0, row.mass, true), closed, counting)
        << row.elements << " elements";
  }
}

TEST(Dispersion, SixTermsLeaveAMillionthAtTenElementsPerWave) {
  Vibration w(20, 20.0, MassForm::lumped, 0.1);
  w.explicit_terms(6);
  w.start_mode(4);  // 10 elements per wave
  const double k = 2.0 * pi / 10.0;
  // The error of P terms is of the order (k h / 2)^(2 P) = 1e-6 at most; the counting adds its own.
  EXPECT_NEAR(w.frequency(40000.0) / k, 1.0, counting + 1e-6);
}

}  // namespace
}  // namespace abut::solver_energy_tests
