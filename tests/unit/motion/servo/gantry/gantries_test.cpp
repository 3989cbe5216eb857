#include "servo/gantry/gantries.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::ElementsAre, testing::IsEmpty, testing::HasSubstr;

/// One joint on three motors, which stands where their mean stands; 1 rad a mm and a third of the effort each.
class Tripod final : public ActuatorMap {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 1; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> q, std::span<double> a) const noexcept override {
    std::fill(a.begin(), a.begin() + 3, q[0]);
  }
  void joint_positions(std::span<const double> a, std::span<double> q) const noexcept override {
    q[0] = (a[0] + a[1] + a[2]) / 3;
  }
  void joint_velocities(std::span<const double>, std::span<const double> ad,
                        std::span<double> qd) const noexcept override {
    joint_positions(ad, qd);
  }
  void actuator_efforts(std::span<const double>, std::span<const double> e,
                        std::span<double> t) const noexcept override {
    std::fill(t.begin(), t.begin() + 3, e[0] / 3);
  }
};

class GantriesTest : public testing::Test {
 protected:
  static constexpr double kMaxEffort = 900;
  explicit GantriesTest() { parts_ = made_of(std::make_shared<Tripod>(), 1, 3); }

  static ServoLoopParts made_of(std::shared_ptr<const ActuatorMap> map, std::size_t joints, std::size_t motors,
                                const std::array<int, kMaxJoints>& delays = {}) {
    const auto fake = std::make_shared<FakeBus>(motors);
    fake->delays = delays;
    const auto bus = std::make_shared<ServoBus>(fake);
    ServoLoopParts parts;
    parts.actuator_map = std::move(map);
    for (std::size_t j = 0; j < joints; ++j)
      parts.joints.push_back({std::make_shared<RecordingLaw>(), ControlMethod::Position, 0.5, kMaxEffort});
    parts.joints[0].gantry = Gantry{.max_skew = 0.4, .stiffness = 1000};
    for (std::uint32_t i = 0; i < motors; ++i) parts.actuators.push_back({bus, i, {1000, 1, 1, 0}});
    return parts;
  }
  [[nodiscard]] Gantries made() {
    wiring_.emplace(*parts_.actuator_map, parts_.joints.size(), parts_.actuators);
    return Gantries(parts_, *wiring_);
  }
  /// Torques of three motors that stand so, where they belong at 0.
  std::vector<double> torques(const std::array<double, 3>& shafts, double effort) {
    Gantries gantries = made();
    const std::array<double, 3> still{};
    gantries.read(still, still);
    gantries.engage(0);
    gantries.read(shafts, still);
    gantries.watch(0, {}, faults_);
    gantries.hold(0, effort);
    return {gantries.torques_nm().begin(), gantries.torques_nm().begin() + 3};
  }

  ServoLoopParts parts_;
  std::optional<Wiring> wiring_;
  RecordedFaults faults_;
};

TEST_F(GantriesTest, PushTheirJointNowhere) {
  for (const double effort : {0.0, 500.0, 880.0, -900.0}) {
    for (const std::array<double, 3>& shafts : {std::array{0.04, -0.02, -0.02}, {0.2, -0.1, -0.1}, {-0.3, 0.1, 0.2}}) {
      const std::vector<double> made = torques(shafts, effort);
      EXPECT_NEAR(std::accumulate(made.begin(), made.end(), 0.0), 0, 1e-9);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(made[i] * shafts[i], 0) << "it is brought back";
    }
  }
}

TEST_F(GantriesTest, AskNoMotorForMoreThanItsShareOfMaxEffortNorThanMaxSkewAsksFor) {
  // 1 N at the joint is 1 N·m at a shaft here: a third of MaxEffort is 300 N·m.
  EXPECT_NEAR(torques({0.04, -0.02, -0.02}, 0)[0], -40, 1e-9);
  EXPECT_NEAR(torques({0.26, -0.13, -0.13}, 600)[0], -100, 1e-9) << "200 of its 300 are its law's";
  EXPECT_NEAR(torques({0.26, -0.13, -0.13}, -900)[0], 0, 1e-9);
  parts_.joints[0].gantry->stiffness = 200;
  EXPECT_NEAR(torques({0.9, -0.45, -0.45}, 0)[0], -80, 1e-9) << "200 N/mm by 0.4 mm";
}

TEST_F(GantriesTest, AreToldApartAtOneInstantThoughOneDriveTellsLater) {
  parts_ = made_of(std::make_shared<GantryMap>(), 2, 3, {2, 0, 1});
  Gantries gantries = made();
  const double way = 2 * 0.5;  // rad a cycle of 1 ms, at 500 mm/s
  const std::array<double, 3> rad_s{way / kPeriod, 0, -way / kPeriod};
  gantries.read(std::array{0.0, 0.0, 0.0}, std::array{0.0, 0.0, 0.0});
  gantries.engage(0);
  for (int i = 10; i < 20; ++i) {
    // The first tells where it was a cycle before that of which the other tells.
    gantries.read(std::array{way * (i - 1), 0.0, -way * i}, rad_s);
    gantries.watch(0, {.wanted_speed = 500, .answered = true}, faults_);
    EXPECT_NEAR(gantries.ahead()[0], 0, 1e-9);
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(GantriesTest, StopTheMachineWhereTheMapHasNoNumber) {
  (void)torques({std::numeric_limits<double>::quiet_NaN(), 0, 0}, 0);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised.front().kind, ServoFault::Kind::NotANumber);
}

TEST_F(GantriesTest, AreRefusedWhereThereIsNothingToHoldOrDrivesHoldThemselves) {
  const auto refusal = [](const ServoLoopParts& parts) {
    const Wiring wiring(*parts.actuator_map, parts.joints.size(), parts.actuators);
    const auto checked = check_gantries(parts, wiring);
    return checked ? std::string() : checked.error().message;
  };
  EXPECT_EQ(refusal(parts_), "");
  EXPECT_THAT(refusal(made_of(std::make_shared<DirectMap>(), 3, 3)), HasSubstr("not several motors of its own"));
  EXPECT_THAT(refusal(made_of(std::make_shared<DifferentialMap>(), 3, 3)), HasSubstr("not several motors of its own"));
  for (ServoActuator& actuator : parts_.actuators) actuator.mode = DriveMode::CyclicSyncPosition;
  EXPECT_THAT(refusal(parts_), HasSubstr("leave out Stiffness and Damping"));
  parts_.joints[0].gantry->stiffness = 0;
  EXPECT_EQ(refusal(parts_), "");
  parts_.joints[0].gantry->max_skew = 0;
  EXPECT_THAT(refusal(parts_), HasSubstr("a MaxSkew above 0"));
}

}  // namespace
}  // namespace rmac::servo_test
