#include "unit/gateway/simulators/vdrive/node_bench.hpp"

// CiA 402-2: touch probe, profile torque, interpolated position, factors and polarity.
namespace rmac::vdrive::test {
namespace {

using DriveTouchProbe = NodeBench;
using DriveModes = NodeBench;

TEST_F(DriveTouchProbe, LatchesTheFirstEdgeAndNoOtherUntilItWasSwitchedOff) {
  EXPECT_EQ(write(0x60B8, 0, 0x11, 2), 0U);
  EXPECT_EQ(read(0x60B9), 1) << "enabled";
  enable(3);
  EXPECT_EQ(write(0x60FF, 0, 100000, 4), 0U);
  pass(0.2);
  node_.axis().touch(true);
  pass(0.01);
  EXPECT_EQ(read(0x60B9), 3);
  EXPECT_EQ(read(0x60FD) & 0x10000, 0x10000);
  const std::int64_t first = read(0x60BA);
  EXPECT_NEAR(static_cast<double>(read(0x6064) - first), 1000, 100) << "10 ms ago, at 100 000 counts/s";
  node_.axis().touch(false);
  pass(0.01);
  node_.axis().touch(true);
  pass(0.01);
  EXPECT_EQ(read(0x60BA), first);
  EXPECT_EQ(write(0x60B8, 0, 0, 2), 0U);
  EXPECT_EQ(read(0x60B9), 0);
  EXPECT_EQ(write(0x60B8, 0, 0x11, 2), 0U);
  node_.axis().touch(false);
  pass(0.01);
  EXPECT_EQ(read(0x60B9), 1) << "the falling edge was not asked for";
  node_.axis().touch(true);
  pass(0.001);
  EXPECT_EQ(read(0x60B9), 3);
  EXPECT_GT(read(0x60BA), first);
}

TEST_F(DriveTouchProbe, LatchesBothEdgesAndAgainWhereAskedTo) {
  EXPECT_EQ(write(0x60B8, 0, 0x33, 2), 0U);
  enable(3);
  EXPECT_EQ(write(0x60FF, 0, 100000, 4), 0U);
  std::int64_t last = 0;
  for (int i = 0; i < 3; ++i) {
    pass(0.1);
    node_.axis().touch(true);
    pass(0.1);
    node_.axis().touch(false);
    pass(0.1);
    EXPECT_EQ(read(0x60B9), 7);
    EXPECT_GT(read(0x60BA), last);
    EXPECT_GT(read(0x60BB), read(0x60BA));
    last = read(0x60BB);
  }
}

TEST_F(DriveTouchProbe, LatchesTheVeryCountWhereItsContactIs) {
  EXPECT_EQ(write(0x2000, 6, 20011, 4), 0U);
  EXPECT_EQ(write(0x2000, 7, 30007, 4), 0U);
  EXPECT_EQ(write(0x60B8, 0, 0x31, 2), 0U);
  enable(3);
  EXPECT_EQ(write(0x60FF, 0, 100000, 4), 0U);
  pass(0.5);
  EXPECT_EQ(read(0x60B9), 7);
  EXPECT_EQ(read(0x60BA), 20011);
  EXPECT_EQ(read(0x60BB), 30007);
}

TEST_F(DriveTouchProbe, LatchesAtTheIndexPulse) {
  EXPECT_EQ(write(0x60B8, 0, 0x1500, 2), 0U);
  enable(3);
  EXPECT_EQ(write(0x60FF, 0, 300000, 4), 0U);
  pass(0.3);
  EXPECT_EQ(read(0x60B9), 0x300);
  EXPECT_EQ(read(0x60BC), 30000);
}

TEST_F(DriveTouchProbe, RefusesSourcesThatItDoesNotHave) {
  EXPECT_EQ(write(0x60B8, 0, 0x19, 2), 0x06090030U);
  EXPECT_EQ(write(0x60B8, 0, 0x1900, 2), 0x06090030U);
}

TEST_F(DriveModes, RampsToATorqueBySlope) {
  EXPECT_EQ(write(0x6087, 0, 1000, 4), 0U);  // the rated torque in a second
  EXPECT_EQ(write(0x6071, 0, 100, 2), 0U);
  enable(4);
  EXPECT_EQ(status() & 0x400, 0);
  pass(0.05);
  EXPECT_NEAR(static_cast<double>(read(0x6074)), 50, 4);
  pass(0.06);
  EXPECT_EQ(read(0x6074), 100);
  EXPECT_EQ(status() & 0x400, 0x400) << "target reached";
  EXPECT_GT(read(0x606C), 0);
  control(0x10F);  // halt
  pass(0.11);
  EXPECT_EQ(read(0x6074), 0);
}

TEST_F(DriveModes, HaltAsTheOptionCodeSaysAndGoOnAfterwards) {
  EXPECT_EQ(write(0x6084, 0, 20000000, 4), 0U);  // half of what the quick stop does
  EXPECT_EQ(write(0x6085, 0, 40000000, 4), 0U);
  EXPECT_EQ(write(0x609A, 0, 20000000, 4), 0U);
  EXPECT_EQ(write(0x6098, 0, 18, 1), 0U);  // towards the positive limit switch
  EXPECT_EQ(write(0x6099, 1, 1000000, 4), 0U);
  EXPECT_EQ(write(0x60FF, 0, 1000000, 4), 0U);
  EXPECT_EQ(write(0x6081, 0, 1000000, 4), 0U);
  EXPECT_EQ(write(0x607A, 0, 2000000000, 4), 0U);
  for (const int mode : {1, 3, 6}) {
    enable(mode);
    for (const int code : {1, 2, 3, 4}) {
      SCOPED_TRACE("mode " + std::to_string(mode) + ", code " + std::to_string(code));
      EXPECT_EQ(write(0x605D, 0, code, 2), 0U);
      const int begin = mode == 3 ? 0 : 0x10;
      control(static_cast<std::uint16_t>(0x0F | begin));
      pass(0.4);
      EXPECT_NEAR(static_cast<double>(read(0x606C)), 1e6, 5000);
      EXPECT_EQ(write(0x6040, 0, 0x10F | begin, 2), 0U);
      double stopped_s = 0;
      for (; std::abs(read(0x606C)) > 3000 && stopped_s < 1; stopped_s += 0.0005) pass(0.0005);
      const double expected_s = code == 1 ? 0.05 : code == 2 ? 0.025 : 0.005;
      EXPECT_NEAR(stopped_s, expected_s, 0.006);
      pass(0.1);
      EXPECT_EQ(state(), 0x27) << "it stays enabled";
      EXPECT_EQ(status() & (mode == 6 ? 0x3400 : 0x0400), 0x0400) << "at rest, and homing is not through";
    }
    control(0x00);
  }
}

TEST_F(DriveModes, InterpolatesBetweenSetpointsWhileItIsTold) {
  EXPECT_EQ(write(0x60C2, 1, 10, 1), 0U);  // 10 ms
  enable(7);
  EXPECT_EQ(status() & 0x1000, 0);
  EXPECT_EQ(write(0x60C1, 1, 5000, 4), 0U);
  pass(0.05);
  EXPECT_EQ(read(0x6064), 0) << "bit 4 is off";
  control(0x1F);
  EXPECT_EQ(status() & 0x1000, 0x1000);
  for (int i = 1; i <= 40; ++i) {
    EXPECT_EQ(write(0x60C1, 1, 500 * i, 4), 0U);
    pass(0.005);
    if (i > 20) {
      EXPECT_NEAR(static_cast<double>(read(0x6062)), 500 * i - 250, 60) << "half way, after half of the time";
    }
    pass(0.005);
  }
  pass(0.1);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 20000, 100);
  control(0x0F);
  EXPECT_EQ(write(0x60C1, 1, 0, 4), 0U);
  pass(0.05);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 20000, 100);
}

TEST_F(DriveModes, CountsInTheUnitsOfItsFactors) {
  EXPECT_EQ(read(0x6092, 1), 131072);
  EXPECT_EQ(write(0x6092, 1, 10000, 4), 0U);  // 10000 a turn of the shaft
  EXPECT_EQ(write(0x6091, 1, 2, 4), 0U);      // which is two turns of the motor
  EXPECT_EQ(write(0x6081, 0, 20000, 4), 0U);
  EXPECT_EQ(write(0x607A, 0, 5000, 4), 0U);
  enable(1);
  control(0x1F);
  pass(0.1);
  EXPECT_NEAR(static_cast<double>(read(0x606C)), 20000, 1500);
  pass(1);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 5000, 2);
  EXPECT_NEAR(node_.axis().shaft(), 131072, 60) << "a turn of the motor";
}

TEST_F(DriveModes, TurnsPositionsAndVelocitiesRoundByPolarity) {
  EXPECT_EQ(write(0x607E, 0, 0x80, 1), 0U);
  EXPECT_EQ(write(0x607A, 0, 40000, 4), 0U);
  enable(1);
  control(0x1F);
  pass(1);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 40000, 20);
  EXPECT_NEAR(node_.axis().shaft(), -40000, 20);
  EXPECT_EQ(write(0x6060, 0, 3, 1), 0U);
  EXPECT_EQ(write(0x60FF, 0, 100000, 4), 0U);
  pass(0.2);
  EXPECT_GT(node_.axis().velocity(), 90000) << "bit 6 is off";
  EXPECT_EQ(write(0x607E, 0, 0xC0, 1), 0U);
  pass(0.2);
  EXPECT_LT(node_.axis().velocity(), -90000);
  EXPECT_NEAR(static_cast<double>(read(0x606C)), 100000, 2000);
}

}  // namespace
}  // namespace rmac::vdrive::test
