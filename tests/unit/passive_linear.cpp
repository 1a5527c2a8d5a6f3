// Goal: the passive step of linear bodies keeps energy and momentum to the work and the impulse
// that it is told of, whatever the element, the scheme, the layer and the length of the step.
// Oracles: identities of the midpoint rule, free fall.

#include "tests/unit/passive_bodies.hpp"

namespace abut::passive_linear_tests {
namespace {

std::vector<PassiveText> linear_cases() {
  std::vector<PassiveText> all;
  for (PassiveText text : every_element()) {
    for (const char* scheme : {"central_difference: {step: 1.0e-3}", "newmark: {step: 0.01}",
                               "newmark: {step: 0.01, mass: consistent}", "hht_alpha: {step: 0.01}",
                               "generalized_alpha: {step: 0.01, mass: lumped}"}) {
      for (const bool touched : {false, true}) {
        text.scheme = scheme;
        text.touched = touched;
        text.cells = 3;
        all.push_back(text);
      }
    }
  }
  const auto add = [&all](PassiveText text, const std::string& keys, const std::string& model) {
    text.keys = keys;
    text.model = model;
    text.touched = model == "fe";
    all.push_back(text);
  };
  for (const char* scheme : {"central_difference: {step: 1.0e-3}", "newmark: {step: 0.01}"}) {
    const PassiveText plane = {2, "quad4", 3, scheme}, space = {3, "hex8", 3, scheme};
    add(plane, "plane: stress, ", "fe");
    for (const char* formulation : {"formulation: one_point, ", "formulation: mean_dilatation, "}) {
      add(plane, formulation, "fe");
      add(space, formulation, "fe");
    }
    add(plane, "modes: 9, ", "modal");
    add(space, "modes: 9, ", "modal");
  }
  return all;
}

TEST(PassiveLinear, EnergyChangesByTheWorkOfImpulsesLoadsAndSupports) {
  for (PassiveText text : linear_cases()) {
    for (const bool held : {false, true}) {
      if (held && text.model == "modal") continue;  // it has no passive form where it is held
      text.more = text.dim == 2 ? "body_force: [0.1, -0.3]" : "body_force: [0.1, -0.3, 0.2]";
      if (held) text.more += ", constraints: {base: {on: left, x: '0.01 * sin(5 * t)', y: '0'}}";
      SCOPED_TRACE(text.label() + text.more);
      PassiveRun run(text.build());
      double before = 0.0, worked = 0.0, momentum[3] = {};
      run.step(0.01);
      for (const double length : {0.003, 0.1, 0.1, 2.0, 1.0e-4}) {
        const std::vector<double> impulses = run.random_impulses(0.1);
        const PassiveReply first = run.step(length);
        before = first.record.energy.total() - first.record.energy.external_work;
        std::ranges::copy(first.record.momentum, momentum);
        const PassiveReply reply = run.step(length, impulses);
        worked = work_of(impulses, reply, length);
        const BodyRecord& r = reply.record;
        const double now = r.energy.total() - r.energy.external_work;
        // Displacements of up to 10 m round strains and velocities formed over a step, which act
        // on forces of up to 100 N: some 300 values, a few roundings each.
        const double scale = r.energy.total() + std::abs(r.energy.external_work) + 1.0;
        EXPECT_NEAR(now, before + worked, roundoff(1.0e4, scale)) << length;
        if (held) continue;
        const std::vector<double> given = sum_of(impulses, run.dim());
        const double gravity[3] = {0.1, -0.3, 0.2};
        for (std::size_t i = 0; i < run.dim(); ++i)
          EXPECT_NEAR(r.momentum[i], momentum[i] + given[i] + 2.0 * gravity[i] * length,
                      roundoff(1.0e3, 10.0 + 100.0 * length));  // of forces of 100 N
      }
    }
  }
}

TEST(PassiveLinear, AFreeBodyFallsAsOne) {
  for (PassiveText text : linear_cases()) {
    text.more = text.dim == 2 ? "body_force: [0.5, -2.0], initial: {velocity: [1.0, 0.25]}"
                              : "body_force: [0.5, -2.0, 0.0], "
                                "initial: {velocity: [1.0, 0.25, 0.0]}";
    SCOPED_TRACE(text.label());
    PassiveRun run(text.build());
    std::vector<double> moved(run.values(), 0.0);
    PassiveReply reply;
    for (const double length : {0.25, 0.5, 0.125}) {
      reply = run.step(length);
      for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += reply.ports[0].displacement[k];
    }
    const double t = run.time;
    const double way[3] = {t + 0.25 * t * t, 0.25 * t - t * t, 0.0};
    const double speed[3] = {1.0 + 0.5 * t, 0.25 - 2.0 * t, 0.0};
    for (std::size_t k = 0; k < moved.size(); ++k) {
      // Rounding of the stiffness over steps that are hundreds of periods long.
      EXPECT_NEAR(moved[k], way[k % run.dim()], roundoff(1.0e4, 1.0));
      EXPECT_NEAR(reply.ports[0].velocity[k], speed[k % run.dim()], roundoff(1.0e5, 1.0));
    }
    EXPECT_NEAR(reply.record.energy.stored, 0.0, roundoff(1.0e4, 1.0));
  }
}

TEST(PassiveLinear, LoadsThatFollowAndBodiesOfRevolutionKeepTheAccount) {
  for (const char* plane : {"plane: strain, ", "plane: axisymmetric, "}) {
    for (const char* law : {"linear_elastic", "neo_hookean"}) {
      PassiveText text;
      text.keys = plane;
      text.law = law;
      text.cells = 4;
      text.more =
          "loads: {push: {on: top, pressure: '20 * t', follows: true}}, initial: "
          "{position: [1.0, 0.0]}, constraints: {base: {on: bottom, y: '0.05 * t'}}";
      SCOPED_TRACE(text.label());
      double drift[3] = {};
      for (const int fine : {0, 1, 2}) {
        PassiveRun run(text.build());
        const int steps = 20 << fine;
        const double length = 0.4 / steps;
        double worked = 0.0;
        PassiveReply reply;
        for (int k = 0; k < steps; ++k) {
          std::vector<double> impulses = run.random_impulses(0.0);
          for (std::size_t i = 0; i < impulses.size(); i += 2) impulses[i] = -0.5 * length;
          reply = run.step(length, impulses);
          worked += work_of(impulses, reply, length);
        }
        const Energy& energy = reply.record.energy;
        // What moved supports have at the begin is theirs.
        drift[fine] = energy.total() - energy.external_work - worked;
        EXPECT_GT(std::abs(energy.external_work), 1.0e-3);
      }
      if (text.law == "linear_elastic") {
        EXPECT_NEAR(drift[1], drift[0], roundoff(1.0e4, 1.0));
      } else {
        EXPECT_GT(observed_order(drift[1] - drift[0], drift[2] - drift[1]), 1.7);
      }
    }
  }
}

TEST(PassiveLinear, AStepOfNoLengthTellsWhereTheBodyIs) {
  for (const PassiveText& text : linear_cases()) {
    SCOPED_TRACE(text.label());
    PassiveRun run(text.build());
    const std::vector<double> impulses = run.random_impulses(0.1);
    const PassiveReply reply = run.step(0.01, impulses);
    const std::uint64_t hash = run.body().state_hash();
    const PassiveReply none = run.step(0.0);
    EXPECT_EQ(run.body().state_hash(), hash);
    for (std::size_t k = 0; k < run.values(); ++k) {
      EXPECT_NEAR(none.ports[0].displacement[k], reply.ports[0].displacement[k], roundoff(10, 1.0));
      EXPECT_EQ(none.ports[0].velocity[k], reply.ports[0].velocity[k]);
    }
  }
}

TEST(PassiveLinear, ComplianceIsWhatImpulsesAddToTheMeanVelocity) {
  for (PassiveText text : linear_cases()) {
    for (const bool inclined : {false, true}) {
      if (inclined && text.model == "modal") continue;
      text.more = !inclined       ? ""
                  : text.dim == 2 ? "constraints: {roll: {on: left, direction: [3.0, 4.0]}}"
                                  : "constraints: {roll: {on: left, direction: [3.0, 4.0, 1.0]}}";
      if (inclined && text.touched && text.scheme.find("newmark") == std::string::npos) continue;
      SCOPED_TRACE(text.label() + text.more);
      PassiveRun run(text.build());
      const double length = 0.02;
      run.step(length, run.random_impulses(0.1));
      run.body().save();
      const std::vector<std::int32_t> pressed = {0, 2};
      const PassiveReply none = run.step(length, {}, pressed);
      const std::size_t dim = run.dim(), count = pressed.size() * dim;
      ASSERT_EQ(none.compliance.size(), count * count);
      const auto value = [&](std::size_t k) { return index(pressed[k / dim]) * dim + k % dim; };
      for (std::size_t j = 0; j < count; ++j) {
        run.body().restore();
        run.time -= length;
        std::vector<double> unit(run.values(), 0.0);
        unit[value(j)] = 1.0;
        const PassiveReply reply = run.step(length, unit);
        for (std::size_t i = 0; i < count; ++i) {
          const double change =
              (reply.ports[0].displacement[value(i)] - none.ports[0].displacement[value(i)]) /
              length;
          const double told = none.compliance[i * count + j];
          // Compliances are about 1/(2 m) of a node, 100, solved to the factors' length.
          EXPECT_NEAR(change, told, 1.0e-7 * none.compliance[j * count + j]);
          EXPECT_EQ(told, none.compliance[j * count + i]);
        }
        EXPECT_GT(none.compliance[j * count + j], 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace abut::passive_linear_tests
