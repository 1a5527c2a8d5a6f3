// Goal: every kind of body under every scheme, law and formulation comes back to a saved state bit
// for bit, and so does another one from a checkpoint: with data on its ports, in plastic flow,
// after shortened last substeps. What it tells and draws there is the same. Oracle: equal hashes,
// traces, measures and fields.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/unit/every_body.hpp"

namespace abut::solver_every_rewind_tests {
namespace {

constexpr double instants[] = {0.0, 0.33, 0.61};  // no multiples of the substep

/// What partners do in one of the two windows.
Advance pressed(const Subdomain& body, int w, bool obstructed) {
  Advance request = free_request(body, instants[w], instants[w + 1], 2);
  request.window.index = w;
  const Description& d = body.describe();
  for (std::size_t p = 0; p < request.boundary.size(); ++p) {
    BoundaryData& data = request.boundary[p];
    const std::size_t width = d.ports[p].geometry.points.size();
    const std::vector<double> times = {instants[w], instants[w + 1]};
    if (obstructed) {
      data.obstacles.resize(1);
      data.obstacles[0].motion.time = times;
      data.obstacles[0].motion.u = {-0.01 * w * outward(body, p),
                                    -0.01 * (w + 1) * outward(body, p)};
    } else if (d.can.motion) {
      data.motion.time = times;
      data.motion.u = {0.01 * w, 0.01 * (w + 1)};
      data.motion.v = data.motion.a = {0.1, 0.0};
    } else if (d.can.force) {
      Waveform& force = data.forces.emplace_back(static_cast<int>(width));
      force.time = times;
      const double points = d.ports[p].geometry.count();
      for (std::size_t k = 0; k < 2 * width; ++k)
        force.f.push_back(0.01 * static_cast<double>(1 + w + k / width) / points);
    }
    if (d.can.impulse) data.impulse.assign(width, 0.001);
  }
  return request;
}

void meet_all(Subdomain& body, bool obstructed) {
  for (std::size_t p = 0; obstructed && p < body.describe().ports.size(); ++p)
    meet_point(body, p, body.describe().ports[p].tied);
}

void rewind(const Maker& maker, bool obstructed) {
  const std::unique_ptr<Subdomain> body = maker.make(), twin = maker.make();
  meet_all(*body, obstructed);
  meet_all(*twin, obstructed);
  Response first, second, third;
  step(*body, pressed(*body, 0, obstructed), first);
  const std::uint64_t saved = body->state_hash();
  const std::vector<std::byte> checkpoint = body->checkpoint();
  const std::vector<double> measures = body->measure();
  const std::vector<FieldValues> drawn = body->fields();
  body->save();
  const Advance next = pressed(*body, 1, obstructed);
  step(*body, next, first);
  const std::uint64_t hash = body->state_hash();
  body->restore();
  EXPECT_EQ(body->state_hash(), saved);
  EXPECT_EQ(body->measure(), measures);
  EXPECT_EQ(body->fields(), drawn);
  step(*body, free_request(*body, instants[1], 1.0), second);  // must leave no trace
  body->restore();
  step(*body, next, second);
  EXPECT_EQ(body->state_hash(), hash);
  step(*twin, free_request(*twin, 0.0, 0.1), third);  // nor here
  twin->resume(checkpoint);
  EXPECT_EQ(twin->state_hash(), saved);
  EXPECT_EQ(twin->measure(), measures);
  EXPECT_EQ(twin->fields(), drawn);
  step(*twin, next, third);
  EXPECT_EQ(twin->state_hash(), hash);
  for (std::size_t p = 0; p < first.ports.size(); ++p) {
    EXPECT_EQ(first.ports[p].trace.u, second.ports[p].trace.u);
    EXPECT_EQ(first.ports[p].trace.f, second.ports[p].trace.f);
    EXPECT_EQ(first.ports[p].trace.v, third.ports[p].trace.v);
    EXPECT_EQ(first.ports[p].trace.f, third.ports[p].trace.f);
    EXPECT_EQ(first.ports[p].work, second.ports[p].work);
    EXPECT_EQ(first.ports[p].lower, third.ports[p].lower);
  }
  EXPECT_EQ(first.records[1].energy.total(), third.records[1].energy.total());
  EXPECT_EQ(first.records[1].energy.external_work, third.records[1].energy.external_work);
  EXPECT_EQ(first.records[1].columns, third.records[1].columns);
  EXPECT_EQ(body->measure(), twin->measure());
}

/// Rewinds all that are not refused; tells how many these are.
int rewind_all(const std::vector<Maker>& makers) {
  int rewound = 0;
  for (const Maker& maker : makers) {
    SCOPED_TRACE(maker.name);
    const std::unique_ptr<Subdomain> body = maker.make();
    if (!body) continue;
    ++rewound;
    rewind(maker, false);
    if (body->describe().can.obstacle) rewind(maker, true);
  }
  return rewound;
}

TEST(EveryRewind, OfBarsPairsAndWalls) { EXPECT_GE(rewind_all(bars()), 50); }

TEST(EveryRewind, OfSolidsRigidAndModalBodies) { EXPECT_GE(rewind_all(solids()), 150); }

}  // namespace
}  // namespace abut::solver_every_rewind_tests
