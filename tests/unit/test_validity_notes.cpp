// Goal: a run ends with one sentence on each model that does not fit what its body did.
// Oracle: measures put in by hand.
#include "coordinator/record/validity_notes.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace abut::test_validity_notes {
namespace {

Description body_that_tells() {
  Description body;
  body.name = "arm";
  body.measures = {"energy.kinetic", "energy.stored", "rotation.max", "energy.hourglass_share"};
  return body;
}

TEST(ValidityNotes, AreNoneOfSmallRotationsAndFewHourglasses) {
  // sqrt(1 + 0.14^2) = 1.0098
  EXPECT_TRUE(validity_notes(body_that_tells(), std::vector{1.0, 1.0, 0.14, 0.09}).empty());
}

TEST(ValidityNotes, NameTheBodyTheRotationAndWhatItDoes) {
  const auto notes = validity_notes(body_that_tells(), std::vector{1.0, 1.0, 2.0, 0.0});
  ASSERT_EQ(notes.size(), 1u);
  // sqrt(1 + 2^2) - 1
  for (const char* word : {"'arm' has turned by up to 2 rad", "by 124 %", "saint_venant_kirchhoff"})
    EXPECT_NE(notes[0].find(word), std::string::npos) << notes[0];
}

TEST(ValidityNotes, NameTheShareOfTheHourglasses) {
  const auto notes = validity_notes(body_that_tells(), std::vector{1.0, 1.0, 0.0, 0.3});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("'arm' has 30 % of its stored energy in hourglasses"), std::string::npos)
      << notes[0];
}

TEST(ValidityNotes, LeaveOutWhatABodyAtRestInItselfVibratesBy) {
  EXPECT_TRUE(validity_notes(body_that_tells(), std::vector{1.0, 1.0e-9, 0.0, 0.3}).empty());
}

Description stabilised() {
  Description body;
  body.name = "lid";
  body.measures = {"stabilisation.share",  "stabilisation.share_max", "stabilisation.at_most",
                   "stabilisation.work",   "stabilisation.force",     "stabilisation.force.x",
                   "stabilisation.force.y"};
  return body;
}

TEST(ValidityNotes, TellHowMuchABodyWasStabilised) {
  const std::vector settled{2.0e-4, 0.5, 0.01, 3.0e-3, 1.0, 0.9, 0.1};
  const auto notes = validity_notes(stabilised(), settled);
  ASSERT_EQ(notes.size(), 1u);
  for (const char* word : {"'lid' is held as a whole by contact alone", "0.02 % of the forces",
                           "50 % at most", "0.003 J"})
    EXPECT_NE(notes[0].find(word), std::string::npos) << notes[0];
  EXPECT_EQ(unheld(stabilised(), settled), "");
  EXPECT_EQ(unheld(body_that_tells(), std::vector{1.0, 1.0, 2.0, 0.0}), "");
}

TEST(ValidityNotes, NameTheMotionThatNothingHolds) {
  const auto why = [](double x, double y) {
    return unheld(stabilised(), std::vector{0.02, 0.5, 0.01, 3.0e-3, 1.0, x, y});
  };
  for (const char* word : {"body 'lid' is held against moving along +x by nothing",
                           "2 % of the forces", "1 % are allowed", "stabilisation.stiffness"})
    EXPECT_NE(why(-0.9, 0.1).find(word), std::string::npos) << why(-0.9, 0.1);
  EXPECT_NE(why(0.1, 0.9).find("moving along -y"), std::string::npos);
  EXPECT_NE(why(0.1, -0.2).find("turning as a whole"), std::string::npos);
}

TEST(ValidityNotes, SayThatNothingLiesUnderABodyWhoseSpringsBearAll) {
  const std::string why = unheld(stabilised(), std::vector{1.0, 1.0, 0.01, 7.0, 1.0, 0.0, 1.0});
  for (const char* word : {"body 'lid' presses on nothing", "a hundredth of bodies.lid.integrator",
                           "against moving along -y"})
    EXPECT_NE(why.find(word), std::string::npos) << why;
}

TEST(ValidityNotes, AreNoneWhereNothingWasTold) {
  EXPECT_TRUE(validity_notes(body_that_tells(), {}).empty());
  const Description silent;
  EXPECT_TRUE(validity_notes(silent, std::vector{1.0}).empty());
}

}  // namespace
}  // namespace abut::test_validity_notes
