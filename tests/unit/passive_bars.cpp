// Goal: bars in their passive form keep energy and momentum to the work and the impulse that they
// are told of, whatever their scheme, mass, layer and law, and go there and back without a gain.
// Oracles: identities of the midpoint rule, impulses one by one, free fall.

#include "tests/unit/passive_bodies.hpp"

namespace abut::passive_bars_tests {
namespace {

/// Bars of one law are the bars' own, of the other one solids in one dimension.
std::vector<PassiveText> bars() {
  std::vector<PassiveText> all;
  PassiveText text = {1, "bar2", 12};
  for (const char* law :
       {"linear_elastic: {youngs_modulus: 100.0, density: 2.0}",
        "neo_hookean: {youngs_modulus: 100.0, poissons_ratio: 0.3, density: 2.0}",
        "saint_venant_kirchhoff: {youngs_modulus: 100.0, poissons_ratio: 0.3, density: 2.0}"}) {
    for (const char* scheme :
         {"central_difference: {step: 1.0e-3}", "newmark: {step: 0.01}",
          "newmark: {step: 0.01, mass: lumped}", "newmark: {step: 0.01, mass: consistent}",
          "hht_alpha: {step: 0.01}", "generalized_alpha: {step: 0.01, mass: lumped}"}) {
      for (const bool touched : {false, true}) {
        text.material = law;
        text.scheme = scheme;
        text.touched = touched;
        all.push_back(text);
      }
    }
  }
  return all;
}

std::string bar_text(const PassiveText& text) {
  return fmt::format(
      "bodies: {{it: {{model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 1.0, elements: {}, "
      "area: 0.5}}}}}}}}, material: {{{}}}, integrator: {{{}}}, ports: {{face: {{side: right}}}}"
      "{}{}}}}}",
      text.cells, text.material, text.scheme, text.more.empty() ? "" : ", ", text.more);
}

std::unique_ptr<Subdomain> build(const PassiveText& text) {
  BodyContext context;
  if (text.touched) context.ports.push_back({.port = "face", .touches = true, .partners = {}});
  return make_body(Document::from_text("test", bar_text(text)), "bodies.it", context);
}

double kept(const BodyRecord& r) { return r.energy.total() - r.energy.external_work; }

TEST(PassiveBars, EnergyChangesByTheWorkOfImpulses) {
  for (PassiveText text : bars()) {
    for (const bool held : {false, true}) {
      text.more = "initial: {velocity_field: ['0.3 + 0.1 * sin(3 * x)']}";
      if (held) text.more += ", constraints: {base: {on: left, fixed: true}}";
      SCOPED_TRACE(text.material + text.scheme + text.more);
      PassiveRun run(build(text));
      PassiveReply before = run.step(0.01);
      for (const double length : {0.003, 0.05, 0.1, 1.0e-4}) {
        const std::vector<double> impulses = run.random_impulses(0.05);
        const PassiveReply reply = run.step(length, impulses);
        const double worked = work_of(impulses, reply, length);
        // The midpoint rule keeps the energy of linear bodies exactly, of others to its order.
        const double energy = reply.record.energy.total();
        const double change = kept(reply.record) - kept(before.record);
        if (text.material.starts_with("linear")) {
          EXPECT_NEAR(change, worked, roundoff(1.0e3, energy));
        }
        if (!held) {
          EXPECT_NEAR(reply.record.momentum[0] - before.record.momentum[0], impulses[0],
                      roundoff(1.0e4, 1.0));
        }
        before = reply;
      }
    }
  }
}

/// Of bars that are linear exactly.
TEST(PassiveBars, ComplianceIsWhatOneMoreImpulseAdds) {
  for (PassiveText text : bars()) {
    if (!text.material.starts_with("linear")) continue;
    SCOPED_TRACE(text.scheme);
    for (const double length : {0.01, 0.1}) {
      PassiveRun plain(build(text)), pushed(build(text));
      const PassiveReply none = plain.step(length, {}, {0});
      const PassiveReply some = pushed.step(length, {0.1}, {0});
      ASSERT_EQ(none.compliance.size(), 1u);
      const double added =
          (some.ports[0].displacement[0] - none.ports[0].displacement[0]) / length / 0.1;
      EXPECT_NEAR(added, none.compliance[0], roundoff(100.0, added));
      EXPECT_EQ(some.compliance, none.compliance);
    }
  }
}

TEST(PassiveBars, GoThereAndBackWithTheirEnergy) {
  for (PassiveText text : bars()) {
    for (const bool held : {false, true}) {
      text.more = "initial: {velocity_field: ['0.3 + 0.2 * sin(9 * x)']}";
      if (held) text.more += ", constraints: {base: {on: left, fixed: true}}";
      SCOPED_TRACE(text.material + text.scheme + text.more);
      const std::unique_ptr<Subdomain> body = build(text);
      Advance request;
      request.window = {0, 0.0, 0.05};
      request.boundary.resize(1);
      Response response;
      const auto advance = [&](double begin, double end) {
        request.window = {0, begin, end};
        EXPECT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
        return response.records.at(0);
      };
      const BodyRecord own = advance(0.0, 0.05);
      const double lost = body->passive()->enter();
      // What the other mass loses is given to velocities, in turns that leave half each.
      EXPECT_NEAR(lost, 0.0, 1.0e-9 * own.energy.total());
      PassiveRun run(nullptr, *body, 0.05);
      const BodyRecord passive = run.step(1.0e-12).record;  // as good as none
      EXPECT_NEAR(kept(passive), kept(own) - lost, roundoff(1.0e4, own.energy.total()));
      if (!held) {
        EXPECT_NEAR(passive.momentum[0], own.momentum[0], roundoff(1.0e4, 1.0));
      }
      for (int k = 0; k < 5; ++k) run.step(0.01);
      const BodyRecord last = run.step(0.01).record;
      double left = 0.0;
      ASSERT_TRUE(std::holds_alternative<Advanced>(body->passive()->leave(run.time, left)));
      EXPECT_NEAR(left, 0.0, 1.0e-9 * last.energy.total());  // as above
      const BodyRecord back = advance(run.time, run.time);
      EXPECT_NEAR(kept(back), kept(last) - left, roundoff(1.0e4, last.energy.total()));
      if (!held) {
        EXPECT_NEAR(back.momentum[0], last.momentum[0], roundoff(1.0e4, 1.0));
      }
      const BodyRecord on = advance(run.time, run.time + 0.05);
      // Schemes of finite strain keep their energy to the square of their step.
      EXPECT_LT(kept(on), kept(back) * (1.0 + 1.0e-3));
    }
  }
}

/// Both ends give their mass to nodes within: of two elements to one and the same.
TEST(PassiveBars, OfFewElementsKeepTheirMomentum) {
  for (const int elements : {2, 3, 4}) {
    for (PassiveText text : bars()) {
      SCOPED_TRACE(fmt::format("{} {}{}", elements, text.material, text.scheme));
      BodyContext context;
      for (const char* port : {"face", "tail"})
        context.ports.push_back({.port = port, .touches = text.touched, .partners = {}});
      text.cells = elements;
      text.more = "initial: {velocity_field: ['0.3 + 5 * x']}";
      const std::string whole =
          bar_text(text).replace(bar_text(text).find("face: "), 0, "tail: {side: left}, ");
      const std::unique_ptr<Subdomain> body =
          make_body(Document::from_text("test", whole), "bodies.it", context);
      body->passive()->enter();
      PassiveRun run(nullptr, *body, 0.0);
      for (int k = 0; k < 5; ++k) run.step(0.003);
      const BodyRecord last = run.step(0.003, run.random_impulses(0.05)).record;
      double left = 0.0;
      ASSERT_TRUE(std::holds_alternative<Advanced>(body->passive()->leave(run.time, left)));
      Advance request;
      request.window = {0, run.time, run.time};
      request.boundary.resize(2);
      Response response;
      ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
      EXPECT_NEAR(response.records.at(0).momentum[0], last.momentum[0], roundoff(1.0e4, 1.0));
      EXPECT_LE(kept(response.records.at(0)), kept(last) * (1.0 + roundoff(1.0e4, 1.0)));
    }
  }
}

/// Alpha schemes hold back a part of the impulses while forces change  [M.24]: bodies that go
/// passively then move as fast as what was told.
TEST(PassiveBars, TakeWhatTheSchemeHeldBackWithThem) {
  for (const PassiveText& text : bars()) {
    SCOPED_TRACE(text.material + text.scheme);
    const std::unique_ptr<Subdomain> body = build(text);
    Advance request;
    request.window = {0, 0.0, 0.05};
    request.boundary.resize(1);
    Waveform& push = request.boundary[0].forces.emplace_back();
    push.width = 1;
    for (int k = 0; k <= 5; ++k) {  // [N] up to 0.2: strains of a 250th, the law does not matter
      push.time.push_back(0.01 * k);
      push.f.push_back(-0.04 * k);
    }
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    const double told = response.records.at(0).momentum[0];
    EXPECT_NEAR(told, -0.005, roundoff(1.0e4, 1.0)) << "the impulse of the force";
    const double lost = body->passive()->enter();
    EXPECT_GE(lost, -1.0e-6 * response.records[0].energy.total());
    PassiveRun run(nullptr, *body, 0.05);
    EXPECT_NEAR(run.step(1.0e-12).record.momentum[0], told, roundoff(1.0e4, 1.0));
  }
}

TEST(PassiveBars, AreTakenBackWhereverTheyWere) {
  for (PassiveText text : bars()) {
    SCOPED_TRACE(text.material + text.scheme);
    text.more = "initial: {velocity_field: ['0.3 + 0.2 * sin(9 * x)']}";
    PassiveRun run(build(text));
    run.step(0.01);
    run.body().save();
    const double begin = run.time;
    const PassiveReply once = run.step(0.02, {0.03});
    run.body().restore();
    run.time = begin;
    const PassiveReply again = run.step(0.02, {0.03});
    EXPECT_EQ(once.ports[0].displacement, again.ports[0].displacement);
    EXPECT_EQ(once.record.energy.total(), again.record.energy.total());
  }
}

/// All of what deforms is taken, and nothing of the flight.
TEST(PassiveBars, DampingLeavesTheMotionOfTheCentre) {
  for (PassiveText text : bars()) {
    SCOPED_TRACE(text.material + text.scheme);
    text.more = "initial: {velocity_field: ['0.3 + 0.2 * sin(9 * x)']}";
    PassiveRun run(build(text));
    const BodyRecord before = run.step(0.01).record;
    const double taken = run.body().passive()->damp(before.energy.kinetic);
    const BodyRecord after = run.step(1.0e-12).record;
    const double mass = run.body().describe().mass, p = before.momentum[0];
    EXPECT_NEAR(after.momentum[0], p, roundoff(1.0e3, 1.0));
    EXPECT_NEAR(after.energy.kinetic, 0.5 * p * p / mass, 1.0e-9);  // 1e-12 s of its forces
    EXPECT_NEAR(taken, before.energy.kinetic - after.energy.kinetic, 1.0e-9);
  }
}

}  // namespace
}  // namespace abut::passive_bars_tests
