// A servo loop over drives on CAN whose positions are overwritten on their way: none of them moves by that.
#include <gmock/gmock.h>

#include <random>

#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "unit/fieldbus/canopen/can_wire.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using test::CanWire;
using test::PowerStates;
using test::VirtualDrive;

constexpr double kCountsPerMm = servo_test::kCountsPerMm;
constexpr double kMaxVelocity = 200;  // mm/s
constexpr double kMaxJump = 0.6;      // mm

/// Three joints whose drives follow positions, one motor each; two have a plan.
class ImpossiblePositions : public testing::Test {
 protected:
  void SetUp() override { build(); }
  /// The master stops only after the test's body, whose variables a listener or a gateway may use.
  void TearDown() override {
    wire_.listen = nullptr;
    wire_.gateway = nullptr;
  }

  void build() {
    loop_.reset();
    bus_.reset();
    if (master_) master_->stop();
    master_.reset();
    wire_ = CanWire();
    drives_.clear();
    report_ = {};
    command_ = {};
    for (const auto node : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
      drives_.push_back(&wire_.add(node));
      drives_.back()->put_at(1000.0 * node);
      drives_.back()->acceleration_counts_s2 = 1e12;  // no way of its own while it brakes
    }
    auto config = read_canopen_config("can0", {{"node", {1, 2, 3}}, {"mode", {8}}, {"load_share", {100}}},
                                      {{"tpdo", "6041:00/16 6064:00/32"}}, 0.001);
    ASSERT_TRUE(config) << config.error().message;
    master_ = std::make_shared<CanopenInterface>(*config, [this](std::span<const std::uint16_t>, std::size_t) {
      return Expected<std::unique_ptr<CanPort>>(wire_.open());
    });
    const auto started = master_->start();
    ASSERT_TRUE(started) << started.error().message;
    bus_ = std::make_shared<ServoBus>(master_);
    ServoLoopParts parts;
    parts.kinematics = std::make_shared<servo_test::PlaneKinematics>();
    parts.actuator_map = std::make_shared<servo_test::DirectMap>();
    for (std::uint32_t j = 0; j < 3; ++j) {
      parts.joints.push_back({nullptr, ControlMethod::Position, 1, 5});
      parts.joints.back().bounds = {kMaxVelocity, kMaxJump, 1000};
      parts.actuators.push_back({bus_, j, {2 * std::numbers::pi * kCountsPerMm, 1, 1, 0}});
      parts.actuators.back().mode = DriveMode::CyclicSyncPosition;
    }
    auto made = ServoLoop::create(std::move(parts));
    ASSERT_TRUE(made) << made.error().message;
    loop_ = std::move(*made);
  }

  /// One cycle; each drive is where the last setpoint that counted put it, whatever it seems to be.
  void cycle() {
    std::array<double, 3> before{};
    for (std::size_t i = 0; i < 3; ++i) before[i] = drives_[i]->position();
    if (report_.follows) {
      travelled_ += speed_ * 0.001;
      for (std::size_t j = 0; j < 2; ++j) command_.setpoint.position[j] = begun_[j] + travelled_;
    } else {
      travelled_ = 0;
      for (std::size_t j = 0; j < 2; ++j) command_.setpoint.position[j] = begun_[j] = loop_->hold_position()[j];
    }
    loop_->cycle(command_, report_);
    wire_.pass(milliseconds(1));
    const double fastest = std::max(std::abs(speed_), std::exchange(speed_before_, std::abs(speed_)));
    for (std::size_t i = 0; i < 3; ++i) {
      const double moved_mm = (drives_[i]->position() - before[i]) / kCountsPerMm;
      ASSERT_LE(std::abs(moved_mm), 0.001 * fastest + 0.0021) << "drive " << i << " in cycle " << cycles_;
    }
    ++cycles_;
  }
  void cycles(int count) {
    for (int i = 0; i < count && !HasFatalFailure(); ++i) cycle();
  }
  [[nodiscard]] bool power_on() {
    command_.power = true;
    for (int i = 0; i < 200 && !report_.follows && report_.state != ServoState::Faulted; ++i) cycle();
    return report_.follows;
  }
  void reset() {
    command_.power = false;
    command_.reset = true;
    for (int i = 0; i < 1500 && report_.state != ServoState::Off; ++i) cycle();
    cycles(5);
    command_.reset = false;
    cycles(2);
  }
  void expect_positions_are_true(const std::string& when) const {
    for (std::size_t j = 0; j < 3; ++j) {
      ASSERT_NEAR(report_.position[j], drives_[j]->position() / kCountsPerMm, 0.002) << "joint " << j << ", " << when;
    }
  }

  CanWire wire_;
  std::vector<VirtualDrive*> drives_;
  std::shared_ptr<CanopenInterface> master_;
  std::shared_ptr<ServoBus> bus_;
  std::unique_ptr<ServoLoop> loop_;
  ServoCommand command_;
  ServoReport report_;
  double speed_ = 0, speed_before_ = 0;  ///< mm/s, in this cycle and the one before
  double travelled_ = 0;                 ///< mm
  std::array<double, 2> begun_{};
  int cycles_ = 0;
};

TEST_F(ImpossiblePositions, AreToldApartFromAMachineThatMoves) {
  ASSERT_TRUE(power_on());
  speed_ = 100;
  cycles(300);
  speed_ = -100;
  cycles(300);
  EXPECT_EQ(report_.state, ServoState::Engaged);
  EXPECT_EQ(report_.reference_lost, 0U);
}

// A drive whose answers are lost on their way, as many as are allowed, is asked by SDO, and goes on.
TEST_F(ImpossiblePositions, AreNoneWhenAnswersAreLostNowAndThen) {
  ASSERT_TRUE(power_on());
  speed_ = 50;
  int asked = 0;
  wire_.listen = [&](const CanFrame& frame) {
    asked += frame.id == 0x601 && frame.data[1] == 0x64 && frame.data[2] == 0x60 ? 1 : 0;
  };
  int answer = 0;
  wire_.gateway = [&](const CanFrame& frame) {
    const bool lost = frame.id == 0x181 && ++answer % 50 == 0;
    return lost ? std::vector<CanWire::Time>{} : std::vector<CanWire::Time>{{}};
  };
  cycles(600);
  EXPECT_EQ(report_.state, ServoState::Engaged) << to_string(report_.fault.kind);
  EXPECT_NEAR(asked, 12, 2) << "once for each";
  wire_.listen = nullptr;
}

// A drive that keeps its position to itself but in PDOs is taken by those.
TEST_F(ImpossiblePositions, AreNoneWhereADriveRefusesToTellItsPositionBySdo) {
  drives_[0]->refuse_reading({0x6064, 0}, 0x06010001);
  ASSERT_TRUE(power_on());
  speed_ = 50;
  cycles(200);
  EXPECT_EQ(report_.state, ServoState::Engaged);
}

TEST_F(ImpossiblePositions, MoveNoJointWheneverTheyCome) {
  int stopped = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    build();
    std::mt19937 random(seed);
    const auto pick = [&](unsigned below) { return static_cast<int>(random() % below); };
    const bool powered = pick(4) != 0;
    speed_ = 0;
    if (powered) {
      ASSERT_TRUE(power_on());
      speed_ = pick(201) - 100;
    }
    cycles(5 + pick(60));
    ASSERT_FALSE(HasFatalFailure());
    // Random data in the answers of a drive: in place of its own, one bit of them, or another place.
    const auto victim = static_cast<std::uint16_t>(0x181 + pick(3));
    const int kind = pick(4);
    const auto offset = static_cast<std::uint32_t>(random());
    wire_.gateway = [&, kind, offset, victim](CanFrame& frame) {
      if (frame.id != victim || frame.size < 6) return std::vector<CanWire::Time>{{}};
      std::uint32_t word = long_at(&frame.data[2]);
      if (kind == 0) word = static_cast<std::uint32_t>(random());
      if (kind == 1) word ^= 1U << (12 + random() % 20);
      if (kind == 2) word += offset | 0x1000;
      if (kind == 3) word = random() % 3 == 0 ? static_cast<std::uint32_t>(random()) : word;
      put_long(&frame.data[2], word);
      return std::vector<CanWire::Time>{{}};
    };
    const int lasts = 1 + pick(300);
    for (int i = 0; i < lasts; ++i) {
      if (pick(100) == 0) command_.power = !command_.power;
      cycle();
    }
    ASSERT_FALSE(HasFatalFailure());
    wire_.gateway = nullptr;
    speed_ = 0;
    cycles(30);
    ASSERT_FALSE(HasFatalFailure());
    for (std::size_t j = 0; j < 3; ++j) ASSERT_LT(std::abs(report_.position[j]), 100) << "joint " << j;
    const bool jumped = report_.fault.kind == ServoFault::Kind::EncoderJump;
    stopped += report_.state == ServoState::Faulted ? 1 : 0;
    if (report_.state == ServoState::Faulted) {
      cycles(100);
      for (const VirtualDrive* drive : drives_) ASSERT_NE(drive->state(), PowerStates::OperationEnabled);
    }
    reset();
    ASSERT_EQ(report_.state, ServoState::Off);
    expect_positions_are_true("after a reset");
    ASSERT_EQ(jumped, report_.reference_lost != 0);
    ASSERT_TRUE(power_on()) << to_string(report_.fault.kind);
    expect_positions_are_true("under power again");
  }
  EXPECT_GT(stopped, 300);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
