#include "gateway/rmac_cam/settings/cam_path_settings.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

class PathSettings : public testing::Test {
 protected:
  PathSettings() {
    mill_.max_feedrate_mm_min = 6000;
    mill_.path_accel_rise_mm_s2 = 800;
    mill_.path_accel_fall_mm_s2 = 900;
    device_.change(&mill_);
    settings_.mechanism_changed(true);
  }
  sdk::DeviceObject mill_;
  DeviceInForce device_;
  CycleHistory history_{1};
  CamPathSettings settings_{device_, history_};
};

TEST_F(PathSettings, BeginWithTheMechanismsBoundsAndNoFeed) {
  EXPECT_EQ(settings_.max_feedrate(), 6000);
  EXPECT_EQ(settings_.accel_rise(), 800);
  EXPECT_EQ(settings_.accel_fall(), 900);
  EXPECT_EQ(settings_.tolerance(), 0);
  EXPECT_EQ(settings_.orientation_tolerance(), 0.1);
  EXPECT_THAT(settings_.check_feed(4).error().message, HasSubstr("move 4: no feed is set"));
}

TEST_F(PathSettings, AreKeptForTheNextMove) {
  ASSERT_TRUE(settings_.set_feedrate(1200));
  ASSERT_TRUE(settings_.set_accel_rise(300));
  ASSERT_TRUE(settings_.set_accel_fall(400));
  ASSERT_TRUE(settings_.set_tolerance(0.05));
  ASSERT_TRUE(settings_.set_orientation_tolerance(0.2));
  EXPECT_TRUE(settings_.check_feed(4));
  EXPECT_EQ(settings_.feed_mm_s(), 20);
  EXPECT_EQ(settings_.max_feed_mm_s(), 100);
  EXPECT_EQ(settings_.accel_rise(), 300);
  EXPECT_EQ(settings_.accel_fall(), 400);
  EXPECT_EQ(settings_.tolerance(), 0.05);
  EXPECT_EQ(settings_.orientation_tolerance(), 0.2);
}

TEST_F(PathSettings, TellTheMeasuredFeed) {
  CycleSample sample;
  sample.cycle = 1;
  sample.feed_actual_mm_s = 3;
  history_.add(sample);
  EXPECT_EQ(settings_.feedrate(), 180);
}

TEST_F(PathSettings, RefuseWhatIsNoSpeedOrAcceleration) {
  for (const double none : {0.0, -1.0, kNotANumber}) {
    EXPECT_EQ(settings_.set_feedrate(none).error().code, MinorCode::InvalidParameterValue);
    EXPECT_EQ(settings_.set_max_feedrate(none).error().code, MinorCode::InvalidParameterValue);
    EXPECT_EQ(settings_.set_accel_rise(none).error().code, MinorCode::InvalidParameterValue);
    EXPECT_EQ(settings_.set_accel_fall(none).error().code, MinorCode::InvalidParameterValue);
  }
  EXPECT_FALSE(settings_.set_tolerance(-1e-9));
  EXPECT_FALSE(settings_.set_tolerance(kNotANumber));
  EXPECT_TRUE(settings_.set_tolerance(0));
  EXPECT_EQ(settings_.set_orientation_tolerance(-0.1).error().message,
            "SetOrientationTolerance: -0.1 degrees must be 0 or more");
  EXPECT_FALSE(settings_.set_orientation_tolerance(kNotANumber));
  EXPECT_TRUE(settings_.set_orientation_tolerance(0));
}

TEST_F(PathSettings, OnlyTightenTheMechanism) {
  EXPECT_TRUE(settings_.set_max_feedrate(6000));
  EXPECT_EQ(settings_.set_max_feedrate(6001).error().code, MinorCode::SpeedLimit);
  EXPECT_EQ(settings_.set_accel_rise(801).error().message,
            "SetPathAccelRise: 801 mm/s² is above the mechanism's 800 mm/s²");
  EXPECT_TRUE(settings_.set_accel_fall(801));
  EXPECT_EQ(settings_.set_accel_fall(901).error().code, MinorCode::AccelerationLimit);
  mill_.path_accel_rise_mm_s2 = 0;
  EXPECT_TRUE(settings_.set_accel_rise(1e5)) << "the joints alone bound it";
}

TEST_F(PathSettings, AFeedAboveALoweredMaximumStopsTheNextMove) {
  ASSERT_TRUE(settings_.set_max_feedrate(3000));
  EXPECT_EQ(settings_.set_feedrate(3001).error().code, MinorCode::SpeedLimit);
  ASSERT_TRUE(settings_.set_feedrate(3000));
  ASSERT_TRUE(settings_.set_max_feedrate(2000));
  const auto refused = settings_.check_feed(7);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::SpeedLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("the feed in force, 3000 mm/min, is above the maximum of 2000"));
}

TEST_F(PathSettings, StayWhenTheSameMechanismIsConfiguredAnewButForItsMaximum) {
  ASSERT_TRUE(settings_.set_feedrate(1200));
  ASSERT_TRUE(settings_.set_max_feedrate(2000));
  ASSERT_TRUE(settings_.set_accel_rise(300));
  ASSERT_TRUE(settings_.set_tolerance(0.1));
  ASSERT_TRUE(settings_.set_orientation_tolerance(0.5));
  mill_.max_feedrate_mm_min = 9000;
  settings_.mechanism_changed(false);
  EXPECT_EQ(settings_.max_feedrate(), 9000) << "upwards too";
  EXPECT_EQ(settings_.feed_mm_s(), 20);
  EXPECT_EQ(settings_.accel_rise(), 300);
  EXPECT_EQ(settings_.tolerance(), 0.1);
  EXPECT_EQ(settings_.orientation_tolerance(), 0.5);
}

TEST_F(PathSettings, StartAnewWithAnotherMechanism) {
  ASSERT_TRUE(settings_.set_feedrate(1200));
  ASSERT_TRUE(settings_.set_accel_fall(300));
  ASSERT_TRUE(settings_.set_tolerance(0.1));
  ASSERT_TRUE(settings_.set_orientation_tolerance(0.5));
  settings_.mechanism_changed(true);
  EXPECT_FALSE(settings_.check_feed(1));
  EXPECT_EQ(settings_.accel_fall(), 900);
  EXPECT_EQ(settings_.tolerance(), 0);
  EXPECT_EQ(settings_.orientation_tolerance(), 0.1);
}

TEST_F(PathSettings, AreTakenUpAgainAsFarAsTheMechanismLets) {
  ASSERT_TRUE(settings_.set_feedrate(1200));
  const CamPathSettings::Values before = settings_.values();
  mill_.max_feedrate_mm_min = 4000;
  settings_.mechanism_changed(true);
  settings_.take_up(before);
  EXPECT_EQ(settings_.feed_mm_s(), 20);
  EXPECT_EQ(settings_.max_feedrate(), 4000);
  mill_.max_feedrate_mm_min = 9000;
  settings_.take_up(before);
  EXPECT_EQ(settings_.max_feedrate(), 6000);
}

TEST_F(PathSettings, NeedAMechanismWhereItBoundsThem) {
  device_.change(nullptr);
  settings_.mechanism_changed(true);
  EXPECT_THAT(settings_.set_feedrate(100).error().message, HasSubstr("no mechanism is loaded"));
  EXPECT_THAT(settings_.set_accel_rise(100).error().message, HasSubstr("SetPathAccelRise: no mechanism is loaded"));
  EXPECT_TRUE(settings_.set_tolerance(0.1));
  EXPECT_EQ(settings_.max_feedrate(), 0);
}

}  // namespace
}  // namespace rmac::gateway
