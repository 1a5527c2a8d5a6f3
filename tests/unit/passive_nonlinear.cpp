// Goal: passive steps of bodies of finite strain keep momentum, drift in energy by the square of
// the step, tell their tangent's compliance, and damp what deforms alone. Oracles: balances,
// orders, differences of replies.

#include "tests/unit/passive_bodies.hpp"

namespace abut::passive_nonlinear_tests {
namespace {

std::vector<PassiveText> finite_cases() {
  std::vector<PassiveText> all;
  for (PassiveText text : every_element()) {
    for (const char* law : {"neo_hookean", "saint_venant_kirchhoff", "hencky"}) {
      text.law = law;
      if (text.element == "tet10" || text.element == "hex20") text.cells = 1;
      all.push_back(text);
    }
  }
  return all;
}

double kept(const PassiveReply& reply) {
  return reply.record.energy.total() - reply.record.energy.external_work;
}

/// Thrown, spun and struck at the begin; the largest change of its energy in 0.4 s.
double drift(const PassiveText& text, int steps) {
  PassiveRun run(text.build());
  const double length = 0.4 / steps;
  double before = 0.0, most = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double now = kept(run.step(length));
    if (k > 0) most = std::max(most, std::abs(now - before));
    if (k == 0) before = now;
  }
  return most / before;
}

TEST(PassiveFinite, EnergyDriftsByTheSquareOfTheStep) {
  for (PassiveText text : finite_cases()) {
    text.more = text.dim == 2
                    ? "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x']}"
                    : "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x', '1.0']}";
    SCOPED_TRACE(text.label());
    const double coarse = drift(text, 40), fine = drift(text, 80), finest = drift(text, 160);
    EXPECT_LT(fine, 2.0e-2);
    EXPECT_GT(observed_order(fine, finest), 1.7) << coarse << " " << fine << " " << finest;
  }
}

TEST(PassiveFinite, PlasticWorkIsAccountedFor) {
  for (PassiveText text : every_element()) {
    if (text.element == "tet10" || text.element == "hex20") text.cells = 1;
    text.material =
        "j2_plasticity: {youngs_modulus: 100.0, poissons_ratio: 0.3, density: 2.0, "
        "yield_stress: 2.0, hardening: 5.0}";
    text.more = text.dim == 2
                    ? "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x']}"
                    : "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x', '1.0']}";
    SCOPED_TRACE(text.label());
    double drift[2] = {};
    for (const int fine : {0, 1}) {
      PassiveRun run(text.build());
      const int steps = fine == 0 ? 80 : 160;
      double before = 0.0;
      for (int k = 0; k < steps; ++k) {
        const Energy energy = run.step(0.4 / steps).record.energy;
        const double now = energy.total() + energy.dissipated;
        if (k == 0) before = now;
        drift[fine] = std::max(drift[fine], std::abs(now - before) / before);
        if (k == steps - 1) {
          EXPECT_GT(energy.dissipated, 0.003 * before);
        }
      }
    }
    EXPECT_LT(drift[0], 2.0e-2);
    EXPECT_LT(drift[1], 0.6 * drift[0]);  // points begin to yield within steps: of order one
  }
}

TEST(PassiveFinite, MomentumIsThatOfTheImpulses) {
  for (PassiveText text : finite_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun run(text.build());
    std::vector<double> momentum(run.dim(), 0.0);
    for (int k = 0; k < 10; ++k) {
      const std::vector<double> impulses = run.random_impulses(0.02);
      const PassiveReply reply = run.step(0.01, impulses);
      const std::vector<double> given = sum_of(impulses, run.dim());
      for (std::size_t i = 0; i < momentum.size(); ++i) {
        momentum[i] += given[i];
        // Newton's steps end where their energy is rounding: 1e-15 of 100 J, in impulses 1e-9.
        EXPECT_NEAR(reply.record.momentum[i], momentum[i], 1.0e-9);
      }
    }
  }
}

TEST(PassiveFinite, ComplianceIsThatOfTheTangent) {
  for (PassiveText text : finite_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun run(text.build());
    const double length = 0.02;
    run.step(length, run.random_impulses(0.02));
    run.body().save();
    const PassiveReply none = run.step(length, {}, {1});
    const std::size_t dim = run.dim();
    for (std::size_t j = 0; j < dim; ++j) {
      std::vector<double> ends[2];
      const double size = 1.0e-5;
      for (const int side : {0, 1}) {
        run.body().restore();
        run.time -= length;
        std::vector<double> unit(run.values(), 0.0);
        unit[dim + j] = side == 0 ? -size : size;
        ends[side] = run.step(length, unit).ports[0].displacement;
      }
      for (std::size_t i = 0; i < dim; ++i) {
        const double change = (ends[1][dim + i] - ends[0][dim + i]) / (2.0 * size * length);
        // By impulses of 1e-5 N s velocities change by 1e-3 m/s, strains over a step by 1e-4.
        EXPECT_NEAR(none.compliance[i * dim + j], change, 1.0e-4 * none.compliance[j * dim + j]);
      }
    }
  }
}

/// Everything of a reply that the coordinator reads.
std::vector<double> numbers_of(const PassiveReply& reply) {
  std::vector<double> all = reply.ports[0].displacement;
  const Energy& energy = reply.record.energy;
  for (const std::vector<double>& more :
       {reply.ports[0].velocity, reply.compliance,
        std::vector<double>{energy.kinetic, energy.stored, energy.dissipated,
                            energy.external_work}})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Nothing of what was tried before from this state or from others, at this length or another one,
/// is seen in a reply: not in one bit.
TEST(PassiveFinite, RepliesDependOnTheStateAndTheRequestAlone) {
  for (PassiveText text : finite_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun tried(text.build()), plain(text.build());
    for (int k = 0; k < 3; ++k) {
      const std::vector<double> impulses = tried.random_impulses(0.05);
      tried.body().save();
      for (const double share : {0.0, -0.5, 0.9}) {
        std::vector<double> others = tried.random_impulses(0.05);
        for (double& impulse : others) impulse *= share;
        PassiveReply ignored;
        for (const double length : {0.01, 0.004}) {
          static_cast<void>(tried.attempt(length, share == 0.0 ? std::vector<double>{} : others,
                                          {0, 1}, ignored));
          tried.body().restore();
          tried.again = true;
          static_cast<void>(tried.attempt(length, impulses, {0}, ignored));
          tried.body().restore();
          tried.again = false;
        }
      }
      PassiveReply ignored;
      tried.body().passive()->damp(1.0e9);  // another state at the same time
      static_cast<void>(tried.attempt(0.01, impulses, {1}, ignored));
      tried.body().restore();
      EXPECT_EQ(numbers_of(tried.step(0.01, impulses, {1})),
                numbers_of(plain.step(0.01, impulses, {1})));
      EXPECT_EQ(numbers_of(tried.step(0.01, {}, {0})), numbers_of(plain.step(0.01, {}, {0})));
    }
  }
}

/// Which is the same answer but for what Newton's method leaves, also where another body would not
/// have come as far, and as well where the last one is far away.
TEST(PassiveFinite, StepsOnceMoreAreThoseFromTheBegin) {
  for (PassiveText text : finite_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun again(text.build()), plain(text.build());
    again.body().save();
    plain.body().save();
    std::vector<double> impulses = again.random_impulses(0.05);
    for (const double change : {0.0, 1.0e-9, 1.0e-3, -1.5}) {
      for (double& impulse : impulses) impulse *= 1.0 + change;
      PassiveReply one, other;
      const Outcome found = again.attempt(0.01, impulses, {0, 1}, one);
      const Outcome expected = plain.attempt(0.01, impulses, {0, 1}, other);
      again.again = true;
      again.body().restore();
      plain.body().restore();
      ASSERT_EQ(found.index(), expected.index());
      ASSERT_TRUE(std::holds_alternative<Advanced>(found));
      double largest = 0.0;
      for (const double moved : other.ports[0].displacement)
        largest = std::max(largest, std::abs(moved));
      const double left = 1.0e-9;  // of it: worse conditioned bodies end earlier than at 1e-12
      for (std::size_t k = 0; k < one.ports[0].displacement.size(); ++k)
        EXPECT_NEAR(one.ports[0].displacement[k], other.ports[0].displacement[k], left * largest);
      EXPECT_NEAR(one.record.energy.total(), other.record.energy.total(),
                  left * other.record.energy.total());
    }
  }
}

TEST(PassiveFinite, CrushedBodiesHaveAnAnswerOrAReason) {
  for (PassiveText text : finite_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun run(text.build());
    std::vector<double> impulses(run.values(), 0.0);
    for (std::size_t k = 0; k < impulses.size(); k += run.dim()) impulses[k] = -20.0;
    run.body().save();
    PassiveReply reply;
    bool done = false;
    for (double length = 0.1; !done && length > 1.0e-5; length *= 0.5) {
      const Outcome outcome = run.attempt(length, impulses, {0}, reply);
      done = std::holds_alternative<Advanced>(outcome);
      if (done) break;
      // Cells that the impulses invert by the step's end, or that the guard of crushed ones makes
      // so stiff on the way there that the search ends without them.
      const Failed::Cause cause = std::get<Failed>(outcome).cause;
      EXPECT_TRUE(cause == Failed::Cause::inverted_element ||
                  cause == Failed::Cause::no_convergence);
      run.body().restore();
    }
    ASSERT_TRUE(done);
    EXPECT_GT(reply.record.energy.total(), 0.0);
    for (std::size_t k = 0; k < run.dim(); ++k) EXPECT_GT(reply.compliance[k * run.dim() + k], 0.0);
  }
}

TEST(PassiveFinite, DampingTakesWhatDeformsAndLeavesTheMomenta) {
  for (PassiveText text : finite_cases()) {
    for (const bool held : {false, true}) {
      text.more = text.dim == 2
                      ? "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x']}"
                      : "initial: {velocity_field: ['1.0 - 2.0 * y + 0.5 * x', '2.0 * x', '1.0']}";
      if (held) text.more += ", constraints: {base: {on: left, y: '0'}}";
      SCOPED_TRACE(text.label() + text.more);
      PassiveRun run(text.build());
      const BodyRecord before = run.step(0.01).record;
      const double some = 0.1 * run.body().passive()->damp(0.0);
      EXPECT_EQ(some, 0.0);
      const double got = run.body().passive()->damp(1.0e-3);
      EXPECT_NEAR(got, 1.0e-3, roundoff(1.0e4, before.energy.total()));
      const double rest = run.body().passive()->damp(1.0e300);
      EXPECT_GT(rest, 0.0);
      EXPECT_NEAR(run.body().passive()->damp(1.0e300), 0.0, roundoff(1.0e4, rest));
      const BodyRecord after = run.step(1.0e-12).record;
      EXPECT_NEAR(after.energy.kinetic, before.energy.kinetic - got - rest,
                  roundoff(1.0e5, before.energy.total()));
      for (std::size_t i = 0; i < run.dim(); ++i) {
        if (held && i == 1) continue;
        EXPECT_NEAR(after.momentum[i], before.momentum[i], roundoff(1.0e4, 1.0));
      }
      if (held) continue;
      for (std::size_t i = 0; i < before.angular_momentum.size(); ++i)
        EXPECT_NEAR(after.angular_momentum[i], before.angular_momentum[i], roundoff(1.0e5, 1.0));
    }
  }
}

}  // namespace
}  // namespace abut::passive_nonlinear_tests
