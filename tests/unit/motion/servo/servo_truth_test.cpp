// Where joints truly are, beside where their drives show them.
#include <gmock/gmock.h>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::DoubleNear;

class ServoTruth : public ServoLoopTest {
 protected:
  static constexpr std::uint32_t kAll = 7;
  static constexpr double kCount = 1.001 / kCountsPerMm;

  void load_at(std::size_t axis, double mm) {
    fake->drives[axis].words.load_counts =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(mm * kCountsPerMm)));
  }
  void expect_truth(double x, double y, double z) const {
    ASSERT_TRUE(report.truth);
    EXPECT_NEAR((*report.truth)[0], x, kCount);
    EXPECT_NEAR((*report.truth)[1], y, kCount);
    EXPECT_NEAR((*report.truth)[2], z, kCount);
  }
};

TEST_F(ServoTruth, IsOfTheLoadsWhileTheLoopSeesTheMotors) {
  fake->loads_told = kAll;
  for (std::size_t axis = 0; axis < 3; ++axis) put_at(axis, 10), load_at(axis, 9.5);
  build();
  engage();
  expect_truth(9.5, 9.5, 9.5);
  EXPECT_EQ(report.position[0], 10);
  EXPECT_EQ(laws[0]->last.position, 10);
  load_at(1, -3);
  cycle();
  expect_truth(9.5, -3, 9.5);
  EXPECT_EQ(report.position[1], 10);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None) << "no watch looks at it";
  EXPECT_EQ(laws[1]->last.position, 10) << "no law looks at it";
}

// Red where zeros stand for what is not told.
TEST_F(ServoTruth, IsNotToldWhereOneDriveDoesNotKnowIt) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    fake->loads_told = kAll & ~(1U << axis);
    build();
    engage();
    EXPECT_FALSE(report.truth) << "axis " << axis;
  }
  fake->loads_told = kAll;
  ServoLoopParts virtual_parts = parts();
  virtual_parts.virtual_mode = true;
  build(std::move(virtual_parts));
  cycle(3);
  EXPECT_FALSE(report.truth) << "without drives there are no loads";
}

TEST_F(ServoTruth, GoesThroughTheActuatorMap) {
  fake->loads_told = kAll;
  build(parts(std::make_shared<DifferentialMap>()));
  for (std::size_t axis = 0; axis < 3; ++axis) put_at(axis, 0);
  load_at(0, 7), load_at(1, 3), load_at(2, -4);
  cycle();
  expect_truth(5, 2, -4);
}

// The load is behind the play, and before what a screw's pitch does wrong.
TEST_F(ServoTruth, HasPitchErrorsInItAndNoBacklash) {
  fake->loads_told = kAll;
  ServoLoopParts made = parts();
  made.joints[0].mechanics.pitch = {.first = 0, .step = 10, .errors = {0.1, 0.3}};
  made.joints[0].mechanics.backlash = 0.2;
  build(std::move(made));
  put_at(0, 5), load_at(0, 7.5);
  cycle();
  expect_truth(7.5 + 0.25, 0, 0);
}

// The count of a drive wraps, and its encoder may lose its place by more than any load moves.
TEST_F(ServoTruth, GoesOnWhereCountsWrapAndWhereTheEncoderIsShifted) {
  constexpr double kWrap = 2147483.648;
  fake->loads_told = kAll;
  put_at(0, kWrap - 0.01), load_at(0, kWrap - 0.02);
  build();
  cycle();
  expect_truth(kWrap - 0.02, 0, 0);
  put_at(0, kWrap + 0.02), load_at(0, kWrap - 0.005);
  cycle();
  expect_truth(kWrap - 0.005, 0, 0);
  put_at(0, kWrap + 0.01), load_at(0, kWrap + 0.005);
  cycle();
  expect_truth(kWrap + 0.005, 0, 0);
  put_at(0, kWrap + 700);
  cycle();
  expect_truth(kWrap + 0.005, 0, 0);
}

}  // namespace
}  // namespace rmac::servo_test
