// Goal: surfaces whose boxes overlap fly as far as their facets allow, what they have in common
// shortens nothing, and a flight in which they may have met is seen.
// Oracle: two rings, one of them passing the other's box at its corner.

#include "coordinator/coupling/surface_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/coupling/row_margin.hpp"
#include "tests/support/scripted.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::coupling_nearness_tests {
namespace {

constexpr int facets = 400;  // of a ring

PortGeometry ring(double radius) {
  const SurfaceMesh mesh = line(
      facets,
      [radius](double u) {
        const double a = -2.0 * M_PI * u;  // the body inside
        return Eigen::Vector2d(radius * std::cos(a), radius * std::sin(a));
      },
      true);
  PortGeometry geometry;
  geometry.dim = 2;
  geometry.points = mesh.points;
  geometry.facets = mesh.facets;
  geometry.offsets = mesh.offsets;
  nodal_normals(mesh.pose(), geometry.normals);
  return geometry;
}

/// Two rings of radius 1 m, moved and moving as wholes.
struct Rings {
  Scripted a, b;
  Bodies bodies;
  Joint joint;
  Approach seen;

  void look() { seen = joint.watch->approach(joint, bodies); }
  Rings() : a(shaped()), b(shaped()), bodies({&a, &b}) {
    joint = make_surface_joint("rings", {Side{0, 0}, Side{1, 0}}, bodies);
    joint.watch = std::make_unique<SurfaceWatch>(row_margin(joint.sides, bodies), false);
  }
  static Scripted shaped() {
    Scripted body(0.0, 1.0, 1.0);
    body.description_.dim = 2;
    body.description_.ports[0].geometry = ring(1.0);
    return body;
  }
  static void stands(Scripted& body, Eigen::Vector2d at, Eigen::Vector2d speed) {
    PortResponse& port = body.reply.ports[0];
    const std::vector<double>& points = body.description_.ports[0].geometry.points;
    port.trace.width = static_cast<int>(points.size());
    port.trace.time = {0.0};
    port.trace.u.clear();
    port.trace.v.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
      port.trace.u.push_back(at[static_cast<Eigen::Index>(k % 2)]);
      port.trace.v.push_back(speed[static_cast<Eigen::Index>(k % 2)]);
    }
    port.lower = {at.x() - 1.0, at.y() - 1.0};
    port.upper = {at.x() + 1.0, at.y() + 1.0};
    port.speed_bound = speed.norm();
  }
  void stand(Eigen::Vector2d from_a, Eigen::Vector2d speed_a, Eigen::Vector2d speed_b) {
    stands(a, {0.0, 0.0}, speed_a);
    stands(b, from_a, speed_b);
    EXPECT_FALSE(bodies.advance_all());
  }
};

TEST(Nearness, OfRingsInOverlappingBoxesIsThatOfTheirFacets) {
  Rings r;
  r.stand({1.5, 1.5}, {1.0, 0.0}, {0.0, -1.0});
  r.look();
  const double gap = 1.5 * std::sqrt(2.0) - 2.0;
  const double rise = 2.0e-4;  // (2 pi/400)^2/8 of both, and the margin
  EXPECT_NEAR(r.seen.apart, gap, rise);
  EXPECT_NEAR(r.seen.speed, std::sqrt(2.0), roundoff(16, 2.0));
  EXPECT_NEAR(free_flight_horizon({&r.joint, 1}, r.bodies), 0.95 * gap / std::sqrt(2.0), rise);
}

TEST(Nearness, WhatFliesTogetherDoesNotApproach) {
  Rings r;
  r.stand({1.5, 1.5}, {300.0, 40.0}, {300.0, 40.0});
  EXPECT_TRUE(std::isinf(free_flight_horizon({&r.joint, 1}, r.bodies)));
}

TEST(Nearness, ABoundBeyondTheVelocitiesCounts) {
  Rings r;
  r.a.reply.ports[0].speed_bound = 0.0;
  r.stand({1.5, 1.5}, {3.0, 0.0}, {3.0, 0.0});
  r.a.reply.ports[0].speed_bound = 4.0;
  EXPECT_FALSE(r.bodies.advance_all());
  r.look();
  EXPECT_NEAR(r.seen.speed, 1.0, roundoff(16, 4.0));
  r.a.reply.ports[0].speed_bound = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(r.bodies.advance_all());
  r.look();
  EXPECT_TRUE(std::isinf(r.seen.speed));
}

/// Over one second at 1 m/s of closing, with boxes that overlap all the while.
TEST(Nearness, AFlightIsSafeWhereItsEndsLeaveNoTimeToMeet) {
  Rings r;
  const double d = (2.0 + 0.6) / std::sqrt(2.0);
  r.stand({d, d}, {0.0, 0.0}, {-std::sqrt(0.5), -std::sqrt(0.5)});
  r.look();  // .6 m apart
  const auto end_at = [&r](double apart) {
    const double e = (2.0 + apart) / std::sqrt(2.0);
    r.stand({e, e}, {0.0, 0.0}, {-std::sqrt(0.5), -std::sqrt(0.5)});
  };
  end_at(0.45);
  EXPECT_TRUE(r.joint.watch->stayed_apart(r.joint, r.bodies, 1.0));
  end_at(0.35);  // there and back again, it could have touched
  EXPECT_FALSE(r.joint.watch->stayed_apart(r.joint, r.bodies, 1.0));
  end_at(0.01);
  EXPECT_TRUE(r.joint.watch->stayed_apart(r.joint, r.bodies, 0.6));
}

/// The velocities at the ends tell nothing of a way out and back in between, and a bound of the
/// speed would forbid what flies together; the box of velocities that bodies tell does neither.
TEST(Nearness, VelocitiesBetweenTheEndsOfAFlightCount) {
  Rings r;
  const double d = (2.0 + 0.6) / std::sqrt(2.0);
  r.stand({d, d}, {0.0, 0.0}, {0.0, 0.0});
  r.look();  // .6 m apart
  const auto told = [&r](Eigen::Vector2d of_a, Eigen::Vector2d least, Eigen::Vector2d most) {
    r.a.reply.ports[0].slowest = r.a.reply.ports[0].fastest = {of_a.x(), of_a.y()};
    r.b.reply.ports[0].slowest = {least.x(), least.y()};
    r.b.reply.ports[0].fastest = {most.x(), most.y()};
    EXPECT_FALSE(r.bodies.advance_all());
    return r.joint.watch->stayed_apart(r.joint, r.bodies, 1.0);
  };
  EXPECT_TRUE(told({0.0, 0.0}, {0.0, -1.19}, {0.0, 1.19}));  // .595 m there, as far back
  EXPECT_FALSE(told({0.0, 0.0}, {0.0, -1.21}, {0.0, 1.21}));
  EXPECT_TRUE(told({50.0, 0.0}, {50.0, -1.19}, {50.0, 1.19}));
  EXPECT_FALSE(told({50.0, 0.0}, {50.0, -1.0}, {51.0, 1.0}));
}

/// What has gone exactly as far as both ends are apart may have gone through.
TEST(Nearness, AWayThatIsAllThatTheEndsAreApartIsNotSafe) {
  Rings r;
  const auto at = [&r](double along) {
    r.stand({along, 0.5}, {0.0, 0.0}, {-1.0, 0.0});
    r.b.reply.ports[0].slowest = r.b.reply.ports[0].fastest = {-1.0, 0.0};
    r.a.reply.ports[0].slowest = r.a.reply.ports[0].fastest = {0.0, 0.0};
    for (Scripted* ring : {&r.a, &r.b}) {  // swept boxes that overlap
      ring->reply.ports[0].lower = {-9.0, -9.0};
      ring->reply.ports[0].upper = {9.0, 9.0};
    }
    EXPECT_FALSE(r.bodies.advance_all());
  };
  at(2.5);
  r.look();
  const double before = r.seen.apart;
  at(-2.5);
  const double after = before;  // by symmetry
  EXPECT_FALSE(r.joint.watch->stayed_apart(r.joint, r.bodies, before + after));
  EXPECT_TRUE(r.joint.watch->stayed_apart(r.joint, r.bodies, (1.0 - 1.0e-9) * (before + after)));
}

TEST(Nearness, IsThatOfTheBeginWhereAnAttemptWasTakenBack) {
  Rings r;
  r.stand({1.5, 1.5}, {0.0, 0.0}, {0.0, 0.0});
  r.look();
  const double apart = r.seen.apart;
  r.stand({3.0, 3.0}, {0.0, 0.0}, {0.0, 0.0});
  r.bodies.restore_all();
  r.look();
  EXPECT_EQ(r.seen.apart, apart);
}

}  // namespace
}  // namespace abut::coupling_nearness_tests
