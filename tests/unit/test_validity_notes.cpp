// Goal: a run ends with one sentence on each model that does not fit what its body did.
// Oracle: measures put in by hand.
#include "coordinator/record/validity_notes.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace abut {
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
  for (const char* word : {"arm has turned by up to 2 rad", "by 124 %", "saint_venant_kirchhoff"})
    EXPECT_NE(notes[0].find(word), std::string::npos) << notes[0];
}

TEST(ValidityNotes, NameTheShareOfTheHourglasses) {
  const auto notes = validity_notes(body_that_tells(), std::vector{1.0, 1.0, 0.0, 0.3});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("arm has 30 % of its stored energy in hourglasses"), std::string::npos)
      << notes[0];
}

TEST(ValidityNotes, LeaveOutWhatABodyAtRestInItselfVibratesBy) {
  EXPECT_TRUE(validity_notes(body_that_tells(), std::vector{1.0, 1.0e-9, 0.0, 0.3}).empty());
}

TEST(ValidityNotes, AreNoneWhereNothingWasTold) {
  EXPECT_TRUE(validity_notes(body_that_tells(), {}).empty());
  const Description silent;
  EXPECT_TRUE(validity_notes(silent, std::vector{1.0}).empty());
}

}  // namespace
}  // namespace abut
