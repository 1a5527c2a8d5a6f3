// Goal: rigid bodies and tools in their passive form: free motion is exact, energy changes by the
// work of impulses on straight ways, tools give way to nothing. Oracles: closed forms, identities,
// the body's own scheme.

#include <cmath>

#include "tests/unit/passive_bodies.hpp"

namespace abut::passive_rigid_tests {
namespace {

PassiveText rigid(int dim, const std::string& more) {
  PassiveText text;
  text.dim = dim;
  text.element = dim == 2 ? "quad4" : "hex8";
  text.cells = 2;
  text.model = "rigid";
  text.scheme = "rigid_motion: {step: 0.01}";
  text.more = more;
  text.touched = false;
  return text;
}

const char* spun(int dim) {
  return dim == 2 ? "initial: {velocity_field: ['0.5 - 2.0 * y', '0.1 + 2.0 * x']}"
                  : "initial: {velocity_field: ['0.5 - 2.0 * y + 1.0 * z', '0.1 + 2.0 * x', "
                    "'-1.0 * x']}";
}

TEST(PassiveRigid, FreeMotionIsThatOfTheBodysOwnScheme) {
  for (const int dim : {2, 3}) {
    const std::unique_ptr<Subdomain> own = rigid(dim, spun(dim)).build();
    Advance request;
    request.window = {0, 0.0, 1.0};
    request.boundary.resize(1);
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(own->advance(request, response)));
    PassiveRun run(rigid(dim, spun(dim)).build());
    std::vector<double> moved(run.values(), 0.0);
    PassiveReply reply;
    for (int k = 0; k < 5; ++k) {
      reply = run.step(0.2);
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += reply.ports[0].displacement[i];
    }
    const std::vector<double>& u = response.ports[0].trace.u;
    for (std::size_t i = 0; i < moved.size(); ++i)
      EXPECT_NEAR(moved[i], u[u.size() - moved.size() + i], roundoff(1.0e3, 1.0));
    // Chord and arc: a quarter of a radian and more on arms of up to 0.9 m.
    EXPECT_GT(reply.bulge, 0.005);
    EXPECT_LT(reply.bulge, 0.05);
  }
}

TEST(PassiveRigid, EnergyChangesByTheWorkOnStraightWays) {
  for (const int dim : {2, 3}) {
    for (const char* load : {"", ", body_force: "}) {
      std::string more = spun(dim);
      if (*load != '\0') more += load + std::string(dim == 2 ? "[0.3, -1.0]" : "[0.3, -1.0, 0.1]");
      PassiveRun run(rigid(dim, more).build());
      SCOPED_TRACE(more);
      PassiveReply reply = run.step(0.01);
      for (const double length : {0.001, 0.01, 0.05, 0.1}) {
        for (int k = 0; k < 3; ++k) {
          const BodyRecord before = reply.record;
          const std::vector<double> impulses = run.random_impulses(0.1);
          reply = run.step(length, impulses);
          const Energy& now = reply.record.energy;
          EXPECT_NEAR(now.kinetic - now.external_work,
                      before.energy.kinetic - before.energy.external_work +
                          work_of(impulses, reply, length),
                      // Ways over a step lose its part of a metre in digits; impulses 1 N s.
                      roundoff(1.0e3, 1.0 + 1.0 / length));
          const std::vector<double> given = sum_of(impulses, run.dim());
          const double gravity[3] = {0.3, -1.0, 0.1};
          for (std::size_t i = 0; i < run.dim(); ++i)
            EXPECT_NEAR(
                reply.record.momentum[i],
                before.momentum[i] + given[i] + (*load != '\0' ? 2.0 * gravity[i] * length : 0.0),
                roundoff(1.0e3, 1.0));
        }
      }
    }
  }
}

TEST(PassiveRigid, ComplianceIsWhatSmallImpulsesAddAtRest) {
  for (const int dim : {2, 3}) {
    PassiveRun run(rigid(dim, "").build());
    run.step(0.01);
    run.body().save();
    const std::vector<std::int32_t> pressed = {0, 1};
    const PassiveReply none = run.step(0.01, {}, pressed);
    const std::size_t count = 2 * run.dim();
    ASSERT_EQ(none.compliance.size(), count * count);
    for (std::size_t j = 0; j < count; ++j) {
      run.body().restore();
      run.time -= 0.01;
      std::vector<double> unit(run.values(), 0.0);
      unit[j] = 1.0e-4;
      const PassiveReply reply = run.step(0.01, unit);
      for (std::size_t i = 0; i < count; ++i)
        // The turn of 1e-6 rad bends ways by as much of compliances of a few 1/kg.
        EXPECT_NEAR(reply.ports[0].displacement[i] / 0.01 / 1.0e-4, none.compliance[i * count + j],
                    1.0e-5);
    }
  }
}

TEST(PassiveRigid, SwitchesLoseNothing) {
  for (const int dim : {2, 3}) {
    PassiveRun run(rigid(dim, spun(dim)).build());
    const BodyRecord passive = run.step(0.1).record;
    double lost = 1.0;
    ASSERT_TRUE(std::holds_alternative<Advanced>(run.body().passive()->leave(run.time, lost)));
    EXPECT_EQ(lost, 0.0);
    Advance request;
    request.window = {0, run.time, run.time + 0.1};
    request.boundary.resize(1);
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(run.body().advance(request, response)));
    EXPECT_NEAR(response.records[0].energy.kinetic, passive.energy.kinetic, roundoff(100, 1.0));
    EXPECT_EQ(run.body().passive()->enter(), 0.0);
    EXPECT_EQ(run.body().passive()->damp(1.0), 0.0);
  }
}

TEST(PassiveTool, GoesItsWayAndGivesWayToNothing) {
  for (const int dim : {2, 3}) {
    for (const bool moves : {false, true}) {
      const std::string way =
          dim == 2 ? "['0.3 * t * t', '-0.2 * t']" : "['0.3 * t * t', '-0.2 * t', '0']";
      const std::string text = fmt::format(
          "bodies: {{it: {{model: {{rigid_tool: {{dimension: {}, mesh: {{{}}}{}}}}}, ports: "
          "{{face: {{side: right}}}}}}}}",
          dim, block_mesh(std::vector<double>(index(dim), 1.0), std::vector<int>(index(dim), 2)),
          moves ? ", way: " + way : "");
      PassiveRun run(make_body(Document::from_text("test", text), "bodies.it"));
      run.step(0.5);
      const std::vector<double> impulses = run.random_impulses(1.0);
      const PassiveReply reply = run.step(0.25, impulses, {0, 1});
      for (const double c : reply.compliance) EXPECT_EQ(c, 0.0);
      EXPECT_EQ(reply.compliance.size(), 4 * run.dim() * run.dim());
      const double moved[3] = {0.3 * (0.75 * 0.75 - 0.25), -0.2 * 0.25, 0.0};
      for (std::size_t k = 0; k < run.values(); ++k)
        EXPECT_NEAR(reply.ports[0].displacement[k], moves ? moved[k % run.dim()] : 0.0,
                    roundoff(10, 1.0));
      // No energy of its own: what impulses do is what drives it.
      EXPECT_NEAR(reply.record.energy.external_work + work_of(impulses, reply, 0.25), 0.0,
                  roundoff(100, 10.0));
    }
  }
}

}  // namespace
}  // namespace abut::passive_rigid_tests
