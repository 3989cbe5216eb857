#include "gateway/buses/touch_probe_model.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "gateway/buses/simulated_io.hpp"

// A probe on three slides, whose drives are off: their axes are put where a test has them.
namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr double kPitch_mm = 5, kPeriod_s = 0.001;
constexpr std::uint64_t kTouch = 1U << 2U, kReady = 1U << 3U;

/// The joints are the place of the tool interface.
class Slides final : public Kinematics {
 public:
  std::size_t joint_count() const noexcept override { return 3; }
  JointType joint_type(std::size_t) const noexcept override { return JointType::Linear; }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    pose.tip = {joints[0] + tool.p[0], joints[1] + tool.p[1], joints[2] + tool.p[2]};
    pose.axis = {0, 0, 1};
  }
  KinematicsStatus inverse(const ToolPose&, const Frame&, std::span<const double>,
                           std::span<double>) const noexcept override {
    return KinematicsStatus::OutOfReach;
  }
  void jacobian(std::span<const double>, const Frame&, std::span<double>) const noexcept override {}
};

/// A screw of the same pitch on each.
class Screws final : public ActuatorMap {
 public:
  std::size_t joint_count() const noexcept override { return 3; }
  std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> joints, std::span<double> shafts) const noexcept override {
    for (std::size_t i = 0; i < 3; ++i) shafts[i] = joints[i] / kMmPerRad;
  }
  void joint_positions(std::span<const double> shafts, std::span<double> joints) const noexcept override {
    for (std::size_t i = 0; i < 3; ++i) joints[i] = shafts[i] * kMmPerRad;
  }
  void joint_velocities(std::span<const double>, std::span<const double> shafts,
                        std::span<double> joints) const noexcept override {
    joint_positions(shafts, joints);
  }
  void actuator_efforts(std::span<const double>, std::span<const double>, std::span<double>) const noexcept override {}

 private:
  static constexpr double kMmPerRad = kPitch_mm / (2 * std::numbers::pi);
};

/// Y's drive turns the other way, and X's zero is not its encoder's.
class Touching : public testing::Test {
 protected:
  static constexpr std::int32_t kHomeCounts = 12345;
  static constexpr double kCounts = 131072;

  Touching() { make({}); }

  /// A block whose top is at z = 10, below a tip of 2 mm, 50 mm under the tool interface.
  void make(std::map<std::string, std::vector<double>> more, const PitchErrors& pitch_of_z = {}) {
    more.insert({{"probe_input", {2}},
                 {"probe_ready", {3}},
                 {"probe_stylus_mm", {0, 0, -50}},
                 {"probe_radius_mm", {2}},
                 {"part_block_mm", {-100, -100, 0, 100, 100, 10}}});
    io_ = *make_simulated_io({"SimulatedIOInterface", std::move(more), {}});
    bus_ = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), kPeriod_s);
    feedback_.resize(bus_->axis_count());
    ServoLoopParts parts;
    parts.period_s = kPeriod_s;
    parts.kinematics = std::make_shared<Slides>();
    parts.actuator_map = std::make_shared<Screws>();
    parts.joints.resize(3);
    parts.joints[2].mechanics.pitch = pitch_of_z;
    const auto shared = std::make_shared<ServoBus>(bus_);
    for (std::uint32_t i = 0; i < 3; ++i) {
      ServoActuator actuator;
      actuator.bus = shared;
      actuator.axis = i;
      actuator.scale = scale(i);
      parts.actuators.push_back(std::move(actuator));
    }
    ServoSpindle spindle;
    spindle.bus = shared;
    spindle.axis = 3;
    parts.spindles.push_back(spindle);
    probe_ = *with_touch_probe(io_, parts);
  }
  static DriveScale scale(std::size_t axis) {
    DriveScale scale;
    scale.counts_per_revolution = kCounts;
    scale.direction = axis == 1 ? -1 : 1;
    scale.home_counts = axis == 0 ? kHomeCounts : 0;
    return scale;
  }
  /// The tip's centre is there now, mm.
  void put(double x, double y, double z) {
    const std::array<double, 3> joints{x, y, z + 50};
    for (std::size_t i = 0; i < 3; ++i) {
      const DriveScale of = scale(i);
      bus_->plant(i).put_at(2 * std::numbers::pi * (of.direction * joints[i] / kPitch_mm + of.home_counts / kCounts));
    }
  }
  std::uint64_t exchange() {
    std::uint64_t inputs = 0;
    EXPECT_TRUE(probe_->exchange(0, inputs));
    return inputs;
  }
  /// Whether it is seen to touch there; it takes two exchanges to be told.
  bool touches(double x, double y, double z) {
    put(x, y, z);
    exchange();
    return (exchange() & kTouch) != 0;
  }
  /// Through the states of its drive, up to speed or down to rest.
  void turn_spindle(double rpm) {
    std::vector<DriveCommand> commands(bus_->axis_count());
    commands[3].mode = DriveMode::ProfileVelocity;
    commands[3].target_velocity_rpm = rpm;
    for (int i = 0; i < 6000; ++i) {
      commands[3].controlword = i < 5 ? 0x06 : i < 10 ? 0x07 : 0x0F;
      (void)bus_->exchange(commands, feedback_);
      exchange();
    }
  }

  std::shared_ptr<fieldbus::SimulatedIoInterface> io_;
  std::shared_ptr<fieldbus::SimulatedInterface> bus_;
  std::shared_ptr<DigitalIoInterface> probe_;
  std::vector<DriveFeedback> feedback_;
};

TEST_F(Touching, IsWhereTheTipReallyMeetsThePart) {
  EXPECT_FALSE(touches(0, 0, 12.001));
  EXPECT_TRUE(touches(0, 0, 11.999));
  EXPECT_FALSE(touches(0, 0, 30));
  EXPECT_TRUE(touches(101.9, 0, 5)) << "beside the block, X from its own zero";
  EXPECT_FALSE(touches(102.1, 0, 5));
  EXPECT_TRUE(touches(0, -101.9, 5)) << "Y turns the other way";
  EXPECT_FALSE(touches(0, -102.1, 5));
}

// As the truth in records has them: between the load, which is put, and the joint.
TEST_F(Touching, IsWhereDeclaredPitchErrorsPutTheTip) {
  constexpr double kUp_mm = 0.02;
  make({}, {.first = 0, .step = 100, .errors = {0, kUp_mm, kUp_mm}});
  const double share = (12 + 50) / 100.0;  // of the way to the table's second point, at which the tip is on the part
  EXPECT_FALSE(touches(0, 0, 12));
  EXPECT_FALSE(touches(0, 0, 12 - 0.9 * share * kUp_mm));
  EXPECT_TRUE(touches(0, 0, 12 - 1.1 * share * kUp_mm));
}

TEST_F(Touching, SaysWhenWithinTheCycleItBegan) {
  for (const double share : {0.125, 0.5, 0.8}) {
    make({});
    put(0, 0, 12 + share);
    exchange();
    exchange();
    put(0, 0, 12 + share - 1);
    EXPECT_EQ(exchange() & kTouch, kTouch);
    // From rest to rest in a cycle: 3 u² - 2 u³ of the way when it touches.
    const double on_for = probe_->on_for_s(2) / kPeriod_s, u = 1 - on_for;
    EXPECT_NEAR(u * u * (3 - 2 * u), share, 1e-6);
    EXPECT_EQ(probe_->on_for_s(3), 0) << "of no other input";
    exchange();
    EXPECT_EQ(probe_->on_for_s(2), 0) << "it was on before";
  }
}

TEST_F(Touching, IsReadyAllTheTimeUnlessASpindleSwitchesIt) {
  exchange();
  EXPECT_EQ(exchange() & kReady, kReady);
  make({{"probe_switch_rpm", {300}}});
  exchange();
  EXPECT_EQ(exchange() & kReady, 0U);
  EXPECT_FALSE(touches(0, 0, 5)) << "it is off";
  for (const bool on : {true, false, true}) {
    turn_spindle(on ? 500 : -500);
    EXPECT_NEAR(std::abs(bus_->spindle(3).speed_rpm()), 500, 25);
    turn_spindle(0);
    EXPECT_EQ((exchange() & kReady) != 0, on);
    EXPECT_EQ(touches(0, 0, 5), on);
    put(0, 0, 50);
  }
  turn_spindle(200);
  turn_spindle(0);
  EXPECT_EQ(exchange() & kReady, kReady) << "too slow a turn does not switch it";
}

TEST_F(Touching, BouncesForItsTimeAndNoLonger) {
  make({{"probe_bounce_ms", {20}}});
  put(0, 0, 20);
  exchange();
  exchange();
  put(0, 0, 11);
  exchange();
  EXPECT_EQ(exchange() & kTouch, kTouch) << "the first look finds it";
  int on = 0;
  for (int i = 0; i < 20; ++i) on += (exchange() & kTouch) != 0 ? 1 : 0;
  EXPECT_GT(on, 3);
  EXPECT_LT(on, 17);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(exchange() & kTouch, kTouch);
}

TEST_F(Touching, FailsWithItsDevice) {
  io_->set_failed(true);
  std::uint64_t inputs = 0;
  EXPECT_FALSE(probe_->exchange(0, inputs));
}

TEST_F(Touching, NeedsAProbeAndDrivesThatAreSimulated) {
  ServoLoopParts parts;
  const auto plain = std::make_shared<fieldbus::SimulatedIoInterface>();
  EXPECT_EQ(*with_touch_probe(plain, parts), plain);
  ServoActuator spindle;
  spindle.bus = std::make_shared<ServoBus>(bus_);
  spindle.axis = 3;
  parts.actuators.push_back(spindle);
  const auto refused = with_touch_probe(io_, parts);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("leave \"probe_input\" out"));
}

}  // namespace
}  // namespace rmac::gateway
