#include "mill_on_simulated_bus.hpp"

#include "rmac/motion/servo/servo_handover.hpp"

namespace rmac::mill_test {

// What a PID without feed-forward does at a cycle of 1 ms against the friction of these axes; the reversal is the
// worst, where friction changes its sign while the move starts.
TEST_F(MillOnSimulatedBus, FollowsReversingMovesWithin30Micrometres) {
  Mill mill("mill/3-axis/DMACXYZ", bus_);
  power_up(mill);
  for (const double distance : {20.0, -30.0, 40.0, -25.0, -15.0}) move(mill, distance);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_LT(largest_error_[j], 0.030) << "joint " << j;
    RecordProperty("following_error_um_q" + std::to_string(j + 1), std::to_string(largest_error_[j] * 1e3));
  }
}

// At rest static friction and the integral play against each other: a hunt of some counts that every PID has, and that
// a rest band ends.
class AtRest : public MillOnSimulatedBus {
 protected:
  struct Rest {
    double hunt_mm = 0;   ///< by how much a shaft still moves
    double error_mm = 0;  ///< how far a joint is off
  };
  Rest after_moves(double rest_band_mm) {
    Mill mill("mill/3-axis/DMACXYZ", bus_, [rest_band_mm](nlohmann::json& device) {
      for (nlohmann::json& joint : device["Joints"])
        joint["ServoControlLaw"]["Parameters"]["rest_band"] = {rest_band_mm};
    });
    power_up(mill);
    Rest rest;
    for (const double distance : {20.0, -15.0, 12.5, -17.5}) {
      move(mill, distance);
      dwell(mill, 1000);
      largest_error_.fill(0);
      std::array<double, 3> low{}, high{};
      for (std::size_t j = 0; j < 3; ++j) low[j] = high[j] = table_mm(j);
      for (int i = 0; i < 3000; ++i) {
        cycle(mill);
        for (std::size_t j = 0; j < 3; ++j) {
          low[j] = std::min(low[j], table_mm(j));
          high[j] = std::max(high[j], table_mm(j));
        }
      }
      for (std::size_t j = 0; j < 3; ++j) {
        rest.hunt_mm = std::max(rest.hunt_mm, high[j] - low[j]);
        rest.error_mm = std::max(rest.error_mm, largest_error_[j]);
      }
    }
    RecordProperty("hunt_um", std::to_string(1e3 * rest.hunt_mm));
    RecordProperty("error_um", std::to_string(1e3 * rest.error_mm));
    return rest;
  }
};

TEST_F(AtRest, HuntsByMicrometresWithoutARestBand) {
  const Rest rest = after_moves(0);
  EXPECT_GT(rest.hunt_mm, 0.001);
  EXPECT_LT(rest.error_mm, kHunt);
}

TEST_F(AtRest, StandsWithinItsRestBand) {
  const Rest rest = after_moves(0.002);
  EXPECT_LT(rest.hunt_mm, 0.0001);
  EXPECT_LE(rest.error_mm, 0.0021);
}

class OpeningBrake : public MillOnSimulatedBus {
 protected:
  /// How far the head sinks in the half second in which its drive is enabled.
  double sag(const Mill::Edit& edit = {}) {
    Mill mill("mill/3-axis/DMACXYZ", bus_, edit);
    command_.power = true;
    double lowest = 0;
    for (int i = 0; i < 500; ++i) {
      cycle(mill);
      if (!report_.follows) hold_still(mill);
      lowest = std::min(lowest, table_mm(2));
    }
    EXPECT_NEAR(report_.position[2], report_.position_set[2], kHunt);
    return -lowest;
  }
};

TEST_F(OpeningBrake, LetsTheHeadSagByHundredthsWhereNobodyDeclaresItsLoad) {
  const double mm = sag([](nlohmann::json& device) { device["Joints"][2]["ServoControlLaw"].erase("Parameters"); });
  EXPECT_GT(mm, 0.02);
  EXPECT_LT(mm, 0.2);
}

TEST_F(OpeningBrake, DoesNotMoveTheHeadWhoseLoadIsDeclared) {
  const double mm = sag();
  EXPECT_LT(mm, 0.002);
  RecordProperty("sag_um", std::to_string(mm * 1e3));
}

TEST_F(OpeningBrake, MovesTheHeadLittleWhereItsLoadIsAFifthTooSmall) {
  EXPECT_LT(
      sag([](nlohmann::json& device) { device["Joints"][2]["ServoControlLaw"]["Parameters"]["load"] = {0.8 * 117.7}; }),
      0.015);
}

TEST_F(OpeningBrake, MovesTheHeadLittleWhereItsLoadIsAFifthTooLarge) {
  EXPECT_LT(
      sag([](nlohmann::json& device) { device["Joints"][2]["ServoControlLaw"]["Parameters"]["load"] = {1.2 * 117.7}; }),
      0.015);
}

TEST_F(MillOnSimulatedBus, ChangesFromThreeAxesToTwoWithoutAMovementOrADisabledDrive) {
  Mill three("mill/3-axis/DMACXYZ", bus_);
  power_up(three);
  command_.spindle_rpm[0] = 800;
  move(three, 20);
  dwell(three, 1500);
  const ServoReport before = report_;
  ASSERT_NEAR(before.spindle_rpm[0], 800, 5);

  Mill two("mill/2-axis/DMACXY", bus_);
  two.loop().engage(three.loop().handover());
  hold_still(two);
  for (int i = 0; i < 500 && !failed_; ++i) {
    cycle(two);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(report_.statusword[j] & 0x6F, 0x27) << "drive " << j << " in cycle " << i;
      EXPECT_NEAR(report_.position_set[j], before.position_set[j], 1e-9);
      EXPECT_NEAR(report_.position[j], before.position_set[j], kHunt) << "joint " << j << " in cycle " << i;
    }
    EXPECT_NEAR(report_.spindle_rpm[0], 800, 5);
  }
  ASSERT_TRUE(report_.follows);

  largest_error_.fill(0);
  move(two, -30);
  EXPECT_NEAR(report_.position[0], before.position_set[0] - 30, 0.03);
  EXPECT_LT(largest_error_[2], kHunt) << "the held axis moved";
}

TEST_F(MillOnSimulatedBus, StopsAllAxesWhenOneDriveFails) {
  Mill mill("mill/3-axis/DMACXYZ", bus_);
  power_up(mill);
  simulated_->trip(1, 0x2310);
  command_.setpoint.velocity.fill(0);
  mill.loop().cycle(command_, report_);
  mill.loop().cycle(command_, report_);
  ASSERT_EQ(report_.fault.kind, ServoFault::Kind::DriveFault);
  EXPECT_EQ(report_.fault.index, 1U);
  EXPECT_EQ(report_.fault.value, 0x2310);
  for (int i = 0; i < 300; ++i) mill.loop().cycle(command_, report_);
  const ServoReport stopped = report_;
  for (int i = 0; i < 300; ++i) mill.loop().cycle(command_, report_);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(report_.position[j], stopped.position[j]);
}

TEST_F(MillOnSimulatedBus, TakesAJumpingEncoderForAFollowingError) {
  Mill mill("mill/3-axis/DMACXYZ", bus_);
  power_up(mill);
  simulated_->shift_encoder(0, 131072);  // a turn, 5 mm
  for (int i = 0; i < 3; ++i) mill.loop().cycle(command_, report_);
  EXPECT_EQ(report_.fault.kind, ServoFault::Kind::FollowingError);
  EXPECT_EQ(report_.fault.index, 0U);
}

}  // namespace rmac::mill_test
