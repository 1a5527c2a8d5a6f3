// Goal: a tool that turns is where its way and its angle say, goes straight between its steps, and
// does to its partners what their forces take, in the accurate and in the passive form. Oracles:
// closed forms of a rotation, the identity of work, states that come back.

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "tests/unit/passive_bodies.hpp"

namespace abut::tool_turn_tests {
namespace {

using Eigen::Vector3d;

constexpr double speed = 0.7;  // [rad/s], and it begins at a quarter

/// A block of side 1 that turns about a point that moves, in space about an axis through no corner.
struct Turned {
  int dim = 2;
  double step = 0.0;

  Vector3d axis() const {
    return dim == 2 ? Vector3d(0.0, 0.0, 1.0) : Vector3d(Vector3d(1.0, -2.0, 2.0) / 3.0);
  }
  Vector3d about() const { return {0.3, -0.2, dim == 2 ? 0.0 : 0.4}; }
  Vector3d way(double t) const { return {0.3 * t * t, -0.2 * t, 0.0}; }
  double angle(double t) const { return 0.25 + speed * t; }
  /// Where the point x [m] (dim) of the reference is.
  Vector3d place(const double* x, double t) const {
    const Vector3d arm = Vector3d(x[0], x[1], dim == 2 ? 0.0 : x[2]) - about();
    return about() + way(t) + Eigen::AngleAxisd(angle(t), axis()) * arm;
  }
  std::unique_ptr<Subdomain> build() const {
    const std::string text = fmt::format(
        "bodies: {{it: {{model: {{rigid_tool: {{dimension: {}, mesh: {{{}}}, way: ['0.3 * t * t', "
        "'-0.2 * t'{}], turn: {{about: [{}], {}angle: '0.25 + 0.7 * t'}}{}}}}}, ports: {{face: "
        "{{side: right}}, other: {{side: top}}}}}}}}",
        dim, block_mesh(std::vector<double>(index(dim), 1.0), std::vector<int>(index(dim), 2)),
        dim == 2 ? "" : ", '0'", dim == 2 ? "0.3, -0.2" : "0.3, -0.2, 0.4",
        dim == 2 ? "" : "axis: [1.5, -3, 3], ", step > 0.0 ? fmt::format(", step: {}", step) : "");
    return make_body(Document::from_text("test", text), "bodies.it");
  }
  /// Displacement [m] of a value of a port.
  double shown(const PortGeometry& port, std::size_t value, double t) const {
    const std::size_t d = index(dim), point = value / d;
    const double* x = port.points.data() + point * d;
    return place(x, t)(static_cast<Eigen::Index>(value % d)) - x[value % d];
  }
};

Advance request_of(double begin, double end, std::size_t ports = 2) {
  Advance request;
  request.window = {0, begin, end};
  request.boundary.resize(ports);
  return request;
}

TEST(ToolTurn, ItsTraceIsTheRotation) {
  for (const int dim : {2, 3}) {
    const Turned tool{dim, 0.05};
    const std::unique_ptr<Subdomain> body = tool.build();
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request_of(0.0, 0.2), response)));
    for (std::size_t p = 0; p < 2; ++p) {
      const PortGeometry& port = body->describe().ports[p].geometry;
      const Waveform& trace = response.ports[p].trace;
      ASSERT_EQ(trace.size(), 5u);
      const std::size_t width = index(trace.width);
      double fastest = 0.0;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        for (std::size_t k = 0; k < width; ++k) {
          const double u = tool.shown(port, k, trace.time[i]);
          EXPECT_NEAR(trace.u[i * width + k], u, roundoff(10, 2.0));
          if (i == 0) continue;
          const double before = tool.shown(port, k, trace.time[i - 1]);
          EXPECT_NEAR(trace.v[i * width + k], (u - before) / 0.05, roundoff(10, 2.0 / 0.05));
        }
      }
      for (std::size_t k = 0; k < width; k += index(dim)) {
        double square = 0.0;
        for (std::size_t i = 0; i < index(dim); ++i)
          square += std::pow(trace.v[4 * width + k + i], 2.0);
        fastest = std::max(fastest, std::sqrt(square));
      }
      EXPECT_NEAR(response.ports[p].speed_bound, fastest, roundoff(10, fastest));
    }
    const std::vector<double> told = body->measure();
    EXPECT_EQ(told.size(), 2 * index(dim) + 2);
    EXPECT_EQ(body->describe().measures.back(), "moment");
    EXPECT_NEAR(told[2 * index(dim)], tool.angle(0.2), roundoff(4, 1.0));
  }
}

/// Forces that change within the tool's steps do the work of their impulses on straight ways.
TEST(ToolTurn, WorksByImpulseAndMoment) {
  for (const int dim : {2, 3}) {
    const Turned tool{dim, 0.1};
    const std::unique_ptr<Subdomain> body = tool.build();
    Advance request = request_of(0.0, 0.2);
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    const double begun = response.records[0].energy.external_work;
    const PortGeometry& port = body->describe().ports[1].geometry;
    // On two points of a port, listed; constant in steps of which the tool takes three at once.
    Waveform force(2 * dim);
    force.points = {1, 2};
    force.support = ForceSupport::step;
    for (int i = 0; i <= 6; ++i) force.time.push_back(0.2 + i * 0.2 / 6);
    for (std::size_t k = 0; k < 7 * index(force.width); ++k)
      force.f.push_back(std::sin(1.7 * static_cast<double>(k) + 0.3));
    request = request_of(0.2, 0.4);
    request.boundary[1].forces.push_back(force);
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    double work = 0.0, moment = 0.0;
    std::vector<double> last(index(force.width));
    for (std::size_t k = 0; k < index(force.width); ++k) {
      const std::size_t value = index(force.points[k / index(dim)]) * index(dim) + k % index(dim);
      for (const double from : {0.2, 0.3}) {
        const double to = from + 0.1;
        const std::size_t first = from < 0.25 ? 1 : 4;
        for (std::size_t i = first; i < first + 3; ++i)
          work += force.f[i * index(force.width) + k] / 3.0 *
                  (tool.shown(port, value, to) - tool.shown(port, value, from));
      }
      last[k] = force.f[6 * index(force.width) + k];
    }
    EXPECT_NEAR(response.records[0].energy.external_work - begun, -work, roundoff(1000, 1.0));
    for (std::size_t p = 0; p < 2; ++p) {
      const double* x = port.points.data() + index(force.points[p]) * index(dim);
      Vector3d push = Vector3d::Zero();
      for (std::size_t i = 0; i < index(dim); ++i)
        push(static_cast<Eigen::Index>(i)) = last[p * index(dim) + i];
      const Vector3d arm = tool.place(x, 0.4) - tool.about() - tool.way(0.4);
      moment += tool.axis().dot(arm.cross(push));
    }
    // Told with the forces at the end, on the arms to where the step ends.
    EXPECT_NEAR(body->measure().back(), moment, roundoff(1000, 1.0));
  }
}

TEST(ToolTurn, PassesAsItTurns) {
  for (const int dim : {2, 3}) {
    const Turned tool{dim};
    PassiveRun run(tool.build());
    run.step(0.0);
    const PortGeometry& port = run.body().describe().ports[0].geometry;
    PassiveReply reply = run.step(0.0);
    for (std::size_t k = 0; k < run.values(); ++k)
      EXPECT_NEAR(reply.ports[0].displacement[k], tool.shown(port, k, 0.0), roundoff(10, 2.0));
    reply = run.step(0.1);
    const double begun = reply.record.energy.external_work;
    const std::vector<double> impulses = run.random_impulses(1.0);
    reply = run.step(0.125, impulses, {0, 1});
    for (const double c : reply.compliance) EXPECT_EQ(c, 0.0);
    for (std::size_t k = 0; k < run.values(); ++k)
      EXPECT_NEAR(reply.ports[0].displacement[k],
                  tool.shown(port, k, 0.225) - tool.shown(port, k, 0.1), roundoff(20, 2.0));
    EXPECT_NEAR(reply.record.energy.external_work - begun + work_of(impulses, reply, 0.125), 0.0,
                roundoff(1000, 10.0));
    // Sagitta of the arc, of the longest arm of both ports.
    double farthest = 0.0;
    for (const Port& each : run.body().describe().ports) {
      for (std::size_t k = 0; k < each.geometry.points.size(); k += index(dim)) {
        const Vector3d arm =
            tool.place(each.geometry.points.data() + k, 0.0) - tool.about() - tool.way(0.0);
        farthest = std::max(farthest, arm.norm());
      }
    }
    EXPECT_NEAR(reply.bulge, std::pow(speed * 0.125, 2.0) / 8.0 * farthest, roundoff(10, 1.0));
  }
}

TEST(ToolTurn, GoesNoArcInOneStep) {
  for (const int dim : {2, 3}) {
    const Turned tool{dim};
    const std::unique_ptr<Subdomain> body = tool.build();
    Response response;
    const Outcome outcome = body->advance(request_of(0.0, 1.0), response);
    ASSERT_TRUE(std::holds_alternative<Failed>(outcome));
    const std::string told = std::get<Failed>(outcome).detail;
    for (const char* word : {"turns by 0.7 rad", "model.rigid_tool.step", "0.071 s"})
      EXPECT_NE(told.find(word), std::string::npos) << told;
    PassiveRun run(tool.build());
    run.step(0.0);
    PassiveReply reply;
    EXPECT_TRUE(std::holds_alternative<Failed>(run.attempt(1.0, {}, {}, reply)));
  }
}

/// The state is all there is: saved, restored, written and read.
TEST(ToolTurn, ComesBackBitForBit) {
  for (const int dim : {2, 3}) {
    const Turned tool{dim, 0.05};
    const std::unique_ptr<Subdomain> body = tool.build(), other = tool.build();
    Response first, again, resumed;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request_of(0.0, 0.2), first)));
    body->save();
    const std::vector<std::byte> kept = body->checkpoint();
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request_of(0.2, 0.3), first)));
    const std::uint64_t hash = body->state_hash();
    body->restore();
    EXPECT_NE(body->state_hash(), hash);
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request_of(0.2, 0.3), again)));
    other->resume(kept);
    ASSERT_TRUE(std::holds_alternative<Advanced>(other->advance(request_of(0.2, 0.3), resumed)));
    EXPECT_EQ(body->state_hash(), hash);
    EXPECT_EQ(other->state_hash(), hash);
    for (const Response* reply : {&again, &resumed}) {
      EXPECT_EQ(reply->ports[0].trace.u, first.ports[0].trace.u);
      EXPECT_EQ(reply->ports[0].trace.v, first.ports[0].trace.v);
    }
  }
}

}  // namespace
}  // namespace abut::tool_turn_tests
