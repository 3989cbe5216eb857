#include <gmock/gmock.h>

#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "unit/gateway/simulators/vdrive/wire.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

// The servo loop has drives look for home: over the CANopen master, which knows nothing of these drives but the
// standards.
namespace rmac::vdrive::test {
namespace {

using fieldbus::canopen::CanopenInterface;
using servo_test::DifferentialMap;
using servo_test::DirectMap;
using servo_test::PlaneKinematics;

constexpr std::int32_t kNegativeLimit = -200000, kPositiveLimit = 300000;
constexpr double kCountsPerMm = 131072 / (2 * std::numbers::pi);  // the map's: 1 rad a mm

/// Holds a joint by its stiffness, well damped.
class StiffLaw final : public ServoLaw {
 public:
  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return {}; }
  [[nodiscard]] bool set_gains(std::span<const double>) noexcept override { return true; }
  void set_effort_limit(double) noexcept override {}
  void engage(const ServoInput&, double) noexcept override {}
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    constexpr double kBandwidth = 100;  // 1/s
    const double inertia = fieldbus::AxisPlantParameters().inertia_kg_m2();
    return inertia *
           (kBandwidth * kBandwidth * (input.position_setpoint - input.position) - 2 * kBandwidth * input.velocity);
  }
};

/// Two joints and a held one, with a drive each. The drives of the first two home in turns 1 and 2.
class HomingByDrive : public testing::Test {
 protected:
  void make(const std::vector<double>& methods,
            std::shared_ptr<const ActuatorMap> map = std::make_shared<DirectMap>()) {
    for (std::uint8_t id = 1; id <= 3; ++id) nodes_.push_back(&wire_.add(id));
    auto config = fieldbus::canopen::read_canopen_config(
        "can0", {{"node", {1, 2, 3}}, {"homing_method", methods}, {"homing_speed", {400000}}, {"home_offset", {-5000}}},
        {{"eds", "rmac-vdrive"}, {"setup", "2000:01/32=-200000 2000:02/32=300000"}}, 0.001,
        [](const std::string&, const std::string&) -> Expected<fieldbus::eds::DeviceDescription> { return sheet(); });
    ASSERT_TRUE(config.has_value()) << config.error().message;
    master_ = std::make_shared<CanopenInterface>(*config, [this](std::span<const std::uint16_t>, std::size_t) {
      return Expected<std::unique_ptr<fieldbus::CanPort>>(wire_.open());
    });
    const auto started = master_->start();
    ASSERT_TRUE(started.has_value()) << started.error().message;
    parts_.kinematics = std::make_shared<PlaneKinematics>();
    parts_.actuator_map = std::move(map);
    const auto bus = std::make_shared<ServoBus>(master_);
    for (std::uint8_t i = 0; i < 3; ++i) {
      parts_.joints.push_back({std::make_shared<StiffLaw>(), ControlMethod::Position, 1, 0.9});
      parts_.actuators.push_back(
          {bus, i, {131072, 0.318, 1, 0}, i == 2 ? std::uint8_t{0} : static_cast<std::uint8_t>(i + 1)});
    }
  }
  void engage() {
    auto made = ServoLoop::create(parts_);
    ASSERT_TRUE(made.has_value()) << made.error().message;
    loop_ = std::move(*made);
    command_.power = true;
    ASSERT_TRUE(run_until(1, [this] { return report_.follows; }));
  }
  /// One cycle of 1 ms, as the controller has it: what does not follow is put where the joints hold.
  void cycle() {
    for (std::size_t j = 0; j < 2 && !report_.follows; ++j) command_.setpoint.position[j] = loop_->hold_position()[j];
    loop_->cycle(command_, report_);
    wire_.pass(std::chrono::milliseconds(1));
  }
  template <typename Reached>
  bool run_until(double seconds, Reached&& reached) {
    for (int i = 0; i < static_cast<int>(seconds * 1000); ++i) {
      cycle();
      if (reached()) return true;
    }
    return false;
  }
  [[nodiscard]] std::int64_t mode(std::size_t drive) const { return nodes_[drive]->dictionary().number(0x6061); }

  Wire wire_;
  std::vector<Node*> nodes_;
  std::shared_ptr<CanopenInterface> master_;
  ServoLoopParts parts_;
  std::unique_ptr<ServoLoop> loop_;
  ServoCommand command_;
  ServoReport report_;
};

TEST_F(HomingByDrive, GoesTurnByTurnAndEngagesWhereTheDrivesFoundHome) {
  make({17, 18, 0});
  engage();
  command_.home = true;
  bool second_waited = false;
  ASSERT_TRUE(run_until(30, [&] {
    EXPECT_FALSE(report_.follows && report_.homings == 0 && report_.state == ServoState::Homing);
    EXPECT_NEAR(report_.position[2], report_.position_set[2], 0.02) << "the third joint holds";
    if (mode(0) == 6 && mode(1) == 10) second_waited = true;
    EXPECT_FALSE(mode(1) == 6 && mode(0) == 10 && report_.state == ServoState::Homing && !second_waited);
    return report_.homings == 1 && report_.follows;
  }));
  EXPECT_TRUE(second_waited);
  EXPECT_EQ(report_.state, ServoState::Engaged);
  // Zero lies at home plus the home offset of -5000 counts, so home is at 5000.
  const std::array home{kNegativeLimit, kPositiveLimit};
  for (std::size_t i = 0; i < 2; ++i) {
    const Axis& axis = nodes_[i]->axis();
    EXPECT_NEAR(axis.shaft() - axis.position(), home[i] - 5000, 300) << "drive " << i;
    EXPECT_NEAR(report_.position[i], axis.position() / kCountsPerMm, 0.02) << "joint " << i;
    EXPECT_EQ(mode(i), 10);
  }
  const std::array stands{report_.position[0], report_.position[1]};
  ASSERT_FALSE(run_until(0.5, [&] { return !report_.follows; }));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(report_.position[i], stands[i], 0.02) << "and stay there";

  command_.home = false;
  cycle();
  command_.home = true;
  EXPECT_TRUE(run_until(30, [&] { return report_.homings == 2 && report_.follows; })) << "and again from there";
}

TEST_F(HomingByDrive, EndsWhereItIsWhenItIsNoLongerWanted) {
  make({17, 18, 0});
  engage();
  command_.home = true;
  ASSERT_TRUE(run_until(5, [&] { return report_.position[0] < -1; }));
  command_.home = false;
  ASSERT_TRUE(run_until(2, [&] { return report_.state == ServoState::Engaged; }));
  EXPECT_EQ(report_.homings, 0U);
  EXPECT_EQ(mode(0), 10);
  EXPECT_EQ(mode(1), 10);
  const double stands = report_.position[0];
  ASSERT_FALSE(run_until(0.5, [&] { return !report_.follows; }));
  EXPECT_NEAR(report_.position[0], stands, 0.02);
}

TEST_F(HomingByDrive, FailsWithADriveThatGivesUp) {
  make({7, 18, 0});  // there is no home switch between the limit switches
  engage();
  command_.home = true;
  ASSERT_TRUE(run_until(30, [&] { return report_.state == ServoState::Faulted; }));
  EXPECT_EQ(report_.fault.kind, ServoFault::Kind::HomingFailed);
  EXPECT_EQ(report_.fault.part, ServoFault::Part::Actuator);
  EXPECT_EQ(report_.fault.index, 0U);
  EXPECT_EQ(report_.fault.bound, 0);
  EXPECT_EQ(report_.homings, 0U);
}

TEST_F(HomingByDrive, FailsWithADriveThatTakesTooLong) {
  make({17, 18, 0});
  parts_.homing_timeout_s = 0.05;
  engage();
  command_.home = true;
  ASSERT_TRUE(run_until(1, [&] { return report_.state == ServoState::Faulted; }));
  EXPECT_EQ(report_.fault.kind, ServoFault::Kind::HomingFailed);
  EXPECT_EQ(report_.fault.bound, 0.05);
}

TEST_F(HomingByDrive, StopsAllWhenADriveFaultsMeanwhile) {
  make({17, 18, 0});
  engage();
  command_.home = true;
  ASSERT_TRUE(run_until(5, [&] { return report_.position[0] < -1; }));
  nodes_[0]->axis().set_overheated(true);
  ASSERT_TRUE(run_until(0.1, [&] { return report_.state == ServoState::Faulted; }));
  EXPECT_EQ(report_.fault.kind, ServoFault::Kind::DriveFault);
  command_.home = false;
  EXPECT_TRUE(run_until(1, [&] { return nodes_[2]->axis().state() != PowerStates::OperationEnabled; }));
}

TEST_F(HomingByDrive, BeginsAnewAfterAQuickStopInItsMidst) {
  make({17, 18, 0});
  engage();
  command_.home = true;
  ASSERT_TRUE(run_until(5, [&] { return report_.position[0] < -1; }));
  command_.quick_stop = true;
  command_.power = command_.home = false;
  ASSERT_TRUE(run_until(1, [&] { return nodes_[0]->axis().state() != PowerStates::OperationEnabled; }));
  command_.quick_stop = false;
  cycle();
  command_.power = true;
  ASSERT_TRUE(run_until(2, [&] { return report_.follows; }));
  EXPECT_EQ(mode(0), 10);
  command_.home = true;
  EXPECT_TRUE(run_until(30, [&] { return report_.homings == 1 && report_.follows; }));
}

TEST_F(HomingByDrive, IsRefusedInTurnsThatTearAJointApart) {
  make({17, 18, 0}, std::make_shared<DifferentialMap>());
  const auto made = ServoLoop::create(parts_);
  ASSERT_FALSE(made.has_value());
  EXPECT_THAT(made.error().message, testing::HasSubstr("actuators 0 and 1 move joint 0 together"));
}

}  // namespace
}  // namespace rmac::vdrive::test
