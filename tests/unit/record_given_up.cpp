// Goal: what passive windows cost is told in a sentence with shares, joules by cause and the remedy
// that helps: a finer mesh where contact took it, smaller steps where damping did.
// Oracles: ledgers made by hand.

#include <gtest/gtest.h>

#include "coordinator/record/given_up_words.hpp"
#include "tests/support/refusal.hpp"

namespace abut::record_given_up_tests {
namespace {

struct Told {
  Description one, other;
  std::vector<const Description*> bodies{&one, &other};
  Told() {
    one.name = "brick_1";
    other.name = "brick_3";
  }
  std::string words(const GivenUp& up) const { return given_up_words(up, 200, bodies); }
};

GivenUp passive() {
  return {.windows = 6,
          .halved_windows = 2,
          .steps = 60,
          .normal = 0.375,
          .friction = 1.5,
          .damped = 0.125,
          .push_out = 0.125,
          .deepest = 2.0e-5,
          .largest = 120.0,
          .lost = {0.125, 0.25}};
}

TEST(GivenUp, IsNothingWithoutPassiveWindows) {
  EXPECT_EQ(Told().words({.largest = 1.0}), "");
  EXPECT_FALSE(remedy_of({.windows = 4, .largest = 1.0}));
}

TEST(GivenUp, TellsWhatAccurateWindowsRepaid) {
  EXPECT_EQ(Told().words({.repaid = 0.06, .largest = 120.0}),
            "0.06 J of 120 J that accurate windows had gained were taken back from the swinging of "
            "bodies");
  EXPECT_EQ(Told().words({.repaid = 1.0e-7, .largest = 120.0}), "");
}

TEST(GivenUp, TellsSharesJoulesAndDepth) {
  EXPECT_EQ(Told().words(passive()),
            "3 % of the windows were solved passively, 1 % in shorter steps; 0.375 J of 120 J were "
            "given up in them (0.25 J in normal contact, 0.125 J by damping), and friction took "
            "1.5 J; surfaces were up to 2e-05 m behind each other; a finer mesh of 'brick_3' where "
            "it meets others would lose less");
}

TEST(GivenUp, TellsWhatIsOwedAtTheEndAndNoRemedyForIt) {
  GivenUp up = passive();
  up.damped = up.friction = up.deepest = 0.0;
  up.halved_windows = 0;
  up.owed = 0.25;
  EXPECT_EQ(Told().words(up),
            "3 % of the windows were solved passively; 0.25 J of 120 J were given up in them "
            "(0.25 J in normal contact), of which 0.25 J are given back as bodies part that touch "
            "at the end");
}

TEST(GivenUp, TellsWindowsThatHaveNearlyConverged) {
  EXPECT_EQ(Told().words({.near_windows = 4, .missed = 0.0123, .largest = 1.0}),
            "2 % of the windows have nearly converged, with residuals up to 0.012");
}

TEST(GivenUp, LeavesOutWhatIsNothing) {
  GivenUp up = passive();
  up.damped = 1.0e-9;
  up.friction = up.deepest = 0.0;
  up.halved_windows = 0;
  EXPECT_EQ(Told().words(up),
            "3 % of the windows were solved passively; 0.25 J of 120 J were given up in them "
            "(0.25 J in normal contact); a finer mesh of 'brick_3' where it meets others would "
            "lose less");
}

TEST(GivenUp, TellsWhereStaticsDidNotRest) {
  GivenUp up{.statics = true, .windows = 6, .unsettled = 4, .unbalanced = 0.07, .largest = 1.0};
  EXPECT_EQ(
      Told().words(up),
      "3 % of the windows were solved passively, without inertia, by forces on nodes that "
      "are right to some hundredths where faces press, and less where edges press on few cells, "
      "and "
      "after 4 of their steps bodies did not rest yet: "
      "forces that were not in balance are up to 7 % of the most that a step began with; work "
      "that is told of them is of bodies on their way to rest, so the account of energy stays "
      "open; smaller windows and steps would leave more of them to the accurate method");
  up.unbalanced = 0.95;
  EXPECT_NE(Told().words(up).find("by forces on nodes that cannot be relied on"),
            std::string::npos);
}

TEST(GivenUp, NamesNoRemedyForRestitution) {
  GivenUp up = passive();
  up.normal = up.impacts = 4.0;
  up.damped = up.switched = up.push_out = 0.0;
  up.lost = {1.0e-9};
  up.rigid_windows = 0;
  EXPECT_FALSE(remedy_of(up));
}

TEST(GivenUp, NamesTheRemedyThatHelps) {
  struct Case {
    double normal, damped, switched;
    std::vector<double> lost, taken, refused_by;
    int body;
    bool finer_mesh;
  };
  for (const Case& c : {Case{4.0, 1.0, 1.0, {3.0, 1.0}, {0.0, 2.0}, {}, 0, true},
                        Case{4.0, 1.0, 1.0, {1.0, 3.0}, {2.0}, {5.0}, 1, true},
                        Case{1.0, 1.0, 4.0, {1.0, 0.0}, {0.5, 4.5}, {}, 1, true},
                        Case{1.0, 4.0, 0.0, {1.0}, {1.0, 3.0}, {}, 1, false},
                        Case{1.0, 4.0, 0.0, {1.0}, {1.0, 3.0}, {7.0, 2.0}, 0, false}}) {
    const std::optional<GivenUpRemedy> remedy = remedy_of({.windows = 1,
                                                           .normal = c.normal,
                                                           .damped = c.damped,
                                                           .switched = c.switched,
                                                           .largest = 100.0,
                                                           .lost = c.lost,
                                                           .taken = c.taken,
                                                           .refused_by = c.refused_by});
    ASSERT_TRUE(remedy);
    EXPECT_EQ(remedy->body, c.body);
    EXPECT_EQ(remedy->finer_mesh, c.finer_mesh);
  }
  // rigid bodies lose what rigid bodies lose
  EXPECT_FALSE(remedy_of({.windows = 1, .normal = 4.0, .largest = 100.0}));
  // rounding
  EXPECT_FALSE(remedy_of({.windows = 1, .normal = 1.0e-6, .largest = 100.0, .lost = {1.0e-6}}));
}

TEST(GivenUp, BodiesHeldRigidAreTold) {
  GivenUp up = passive();
  up.rigid_windows = 1;
  expect_words(Told().words(up), {"bodies were held rigid for an instant in 0.5 %"});
}

}  // namespace
}  // namespace abut::record_given_up_tests
