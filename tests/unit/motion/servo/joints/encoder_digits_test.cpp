#include "servo/joints/encoder_digits.hpp"

#include <gtest/gtest.h>

namespace rmac::servo_test {
namespace {

/// A digit is 0.1 µm; 0.01 mm a cycle is a speed that nothing takes away within one.
class Digits : public testing::Test {
 protected:
  Digits() { digits_.begin(0, 0); }
  void tremble(int cycles) {
    for (int i = 0; i < cycles; ++i) digits_.note(i % 2 == 0 ? 1e-4 : 0, 0);
  }
  void stay(double position, int cycles, double effort = 0) {
    for (int i = 0; i < cycles; ++i) digits_.note(position, effort * i);
  }
  EncoderDigits digits_{0.01, 0.001};
};

TEST_F(Digits, FreezeWhereTheyWentToAndFroAndStayForThreeMilliseconds) {
  tremble(14);
  stay(0, 2);
  EXPECT_FALSE(digits_.froze());
  stay(0, 1);
  EXPECT_TRUE(digits_.froze());
  digits_.note(1e-4, 0);
  EXPECT_FALSE(digits_.froze());
}

TEST_F(Digits, AreThoseOfAnEncoderThatRestsWhereTheyDidSoWithoutFreezing) {
  tremble(14);
  stay(0, 10, 2);
  EXPECT_EQ(digits_.usual_change(), 0);
  digits_.note(1e-4, 0);
  EXPECT_EQ(digits_.usual_change(), 18) << "N, which took no digit";
  stay(1e-4, 10);
  EXPECT_FALSE(digits_.froze()) << "its turns count anew";
}

TEST_F(Digits, AreNoisyWhereTheyGoToAndFroBySeveralUnderControl) {
  const auto flicker = [this](double by) {
    for (int i = 0; i < 40; ++i) digits_.note(i % 2 == 0 ? by : 0, 0);
  };
  digits_.note(1e-4, 0);
  flicker(1e-4);
  EXPECT_FALSE(digits_.noisy()) << "at the edge of one";
  flicker(3e-4);
  EXPECT_TRUE(digits_.noisy());
  stay(0, 50);
  EXPECT_TRUE(digits_.noisy()) << "also while it rests";
  digits_.begin(0, 0);
  EXPECT_FALSE(digits_.noisy()) << "what it did without power is no noise of it";
}

TEST_F(Digits, FreezeWhereAJointStopsDeadFromAFastWay) {
  tremble(2);
  for (int i = 1; i <= 3; ++i) digits_.note(0.02 * i, 0);
  stay(0.06, 4);
  EXPECT_TRUE(digits_.froze());
  digits_.begin(0.06, 0);
  stay(0.06, 4);
  EXPECT_FALSE(digits_.froze()) << "under control anew";
}

TEST_F(Digits, AreNotFastByOneOfACoarseScaleNorByOneStep) {
  for (int i = 1; i <= 5; ++i) digits_.note(0.02 * i, 0);  // each a digit, as far as anybody knows
  stay(0.1, 10);
  EXPECT_FALSE(digits_.froze());
  tremble(2);
  digits_.note(0.5, 0);
  stay(0.5, 10);
  EXPECT_FALSE(digits_.froze()) << "a counter that jumped";
}

TEST_F(Digits, TellHowCoarseTheyAreAndNothingOfASilence) {
  EXPECT_EQ(digits_.digit(), 0);
  digits_.note(3e-4, 0);
  digits_.note(4e-4, 0);
  EXPECT_NEAR(digits_.digit(), 1e-4, 1e-12);
  digits_.lose();
  EXPECT_EQ(digits_.step_to(7), 0);
  digits_.note(7, 0);
  EXPECT_EQ(digits_.step_to(7.5), 0.5);
}

}  // namespace
}  // namespace rmac::servo_test
