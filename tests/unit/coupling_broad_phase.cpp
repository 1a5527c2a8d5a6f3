// Goal: of all pairs of surfaces those are found that may come together, and no others.
// Oracle: every pair of boxes compared with every other.

#include "coordinator/coupling/broad_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <set>

#include "tests/support/scripted.hpp"

namespace abut::coupling_broad_phase_tests {
namespace {

/// Boxes of cubes somewhere, each of a body; in two dimensions squares.
struct Crowd {
  int dim;
  std::vector<std::unique_ptr<Scripted>> bodies;
  std::unique_ptr<Bodies> all;

  Crowd(int dimension, int count, double size, unsigned seed) : dim(dimension) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.0, 1.0), speed(0.0, 0.2);
    for (int b = 0; b < count; ++b) {
      bodies.push_back(std::make_unique<Scripted>(0.0, 1.0, 1.0));
      Description& told = bodies.back()->description_;
      told.dim = dim;
      told.mass = b % 7 == 0 ? std::numeric_limits<double>::infinity() : 1.0;
      PortGeometry& surface = told.ports[0].geometry;
      surface.dim = dim;
      surface.points.clear();
      surface.normals.assign(index(2 * dim), 0.0);  // rows need no margin
      PortResponse& port = bodies.back()->reply.ports[0];
      for (int corner = 0; corner < 2; ++corner)
        for (int i = 0; i < dim; ++i)
          surface.points.push_back(corner == 0 ? place(random) : surface.points[i] + size);
      surface.facets = {0, 1};
      surface.offsets = {0, 2};
      port.lower.assign(surface.points.begin(), surface.points.begin() + dim);
      port.upper.assign(surface.points.begin() + dim, surface.points.end());
      port.speed_bound = speed(random);
    }
    std::vector<Subdomain*> pointers;
    for (const auto& body : bodies) pointers.push_back(body.get());
    all = std::make_unique<Bodies>(pointers);
    EXPECT_FALSE(all->advance_all());
  }
  bool meet(int a, int b, double time) const {
    const auto stands = [this](int k) { return std::isinf(bodies[k]->description_.mass); };
    const PortResponse &one = bodies[a]->reply.ports[0],
                       &two = bodies[b]->reply.ports[0];
    const double way = time * (one.speed_bound + two.speed_bound);
    for (std::size_t i = 0; i < index(dim); ++i)
      if (one.lower[i] > two.upper[i] + way || two.lower[i] > one.upper[i] + way) return false;
    return !stands(a) || !stands(b);
  }
};

std::set<std::pair<int, int>> bodies_of(const std::vector<PortPair>& pairs) {
  std::set<std::pair<int, int>> out;
  for (const PortPair& pair : pairs) out.insert(std::minmax(pair[0].body, pair[1].body));
  EXPECT_EQ(out.size(), pairs.size()) << "a pair is told once";
  return out;
}

TEST(BroadPhase, FindsThePairsThatMayMeetAndNoOthers) {
  for (const int dim : {2, 3})
    for (const unsigned seed : {1u, 2u, 3u})
      for (const double time : {0.0, 0.1, 1.0}) {
        const Crowd crowd(dim, 150, dim == 2 ? 0.03 : 0.08, seed);
        BroadPhase phase(*crowd.all, {});
        std::set<std::pair<int, int>> expected;
        for (int a = 0; a < 150; ++a)
          for (int b = a + 1; b < 150; ++b)
            if (crowd.meet(a, b, time)) expected.insert({a, b});
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(bodies_of(phase.near(*crowd.all, time)), expected) << dim << " " << seed;
        if (time == 0.0) {
          EXPECT_EQ(bodies_of(phase.crossed(*crowd.all)), expected);
          EXPECT_EQ(bodies_of(phase.near_at_start(*crowd.all)), expected);
        }
      }
}

TEST(BroadPhase, TellsNoPairThatIsJoined) {
  const Crowd crowd(2, 60, 0.1, 5);
  BroadPhase phase(*crowd.all, {});
  const std::vector<PortPair> first = phase.near(*crowd.all, 0.0);
  ASSERT_GT(first.size(), 2u);
  for (std::size_t k = 0; k < first.size(); k += 2) phase.join(first[k]);
  EXPECT_EQ(phase.near(*crowd.all, 0.0).size(), first.size() / 2);
}

/// Its box is not read from before what it told; all others are found as ever.
TEST(BroadPhase, ABodyThatFailedBeforeItsFirstRecordIsNearNobody) {
  const Crowd crowd(2, 12, 2.0, 1);  // all overlap
  BroadPhase phase(*crowd.all, {});
  std::set<std::pair<int, int>> expected;
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      if (a != 3 && b != 3 && crowd.meet(a, b, 10.0)) expected.insert({a, b});
  PortResponse& failed = crowd.all->response(3).ports[0];
  failed.lower.clear();
  failed.upper.clear();
  EXPECT_EQ(bodies_of(phase.near(*crowd.all, 10.0)), expected);
}

/// A row of bodies sweeps in two levels: each comes before both of its neighbours, or after.
TEST(BroadPhase, NeighboursInARowAlternate) {
  const Crowd crowd(2, 64, 2.0, 1);  // all overlap
  BroadPhase phase(*crowd.all, {});
  for (const PortPair& pair : phase.near(*crowd.all, 0.0)) {
    const auto [low, high] = std::minmax(pair[0].body, pair[1].body);
    if (high != low + 1) continue;
    EXPECT_EQ(pair[0].body % 2, 0) << low;
  }
}

TEST(BroadPhase, FlightsEndBeforeAPairCanMeet) {
  const Crowd crowd(2, 12, 0.01, 3);
  BroadPhase phase(*crowd.all, {});
  constexpr double window = 0.01;
  const int flown = phase.free_windows(*crowd.all, window, 1024);
  EXPECT_TRUE(phase.near(*crowd.all, flown * window).empty());
  ASSERT_LT(flown, 1024);
  EXPECT_FALSE(phase.near(*crowd.all, 2 * flown * window).empty());
}

}  // namespace
}  // namespace abut::coupling_broad_phase_tests
