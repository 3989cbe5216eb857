#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "rmac/motion/drive_power.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_handover.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "unit/motion/servo/period.hpp"

namespace rmac::servo_test {

constexpr double kCountsPerMm = 1000;
constexpr double kRatedNm = 1;

/// Joints x, y along the axes; the tool tip stands on the interface.
class PlaneKinematics : public Kinematics {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 2; }
  [[nodiscard]] JointType joint_type(std::size_t) const noexcept override { return JointType::Linear; }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    pose = {{joints[0] + tool.p[0], joints[1] + tool.p[1], tool.p[2]}, {0, 0, 1}};
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double>,
                                         std::span<double> joints) const noexcept override {
    for (std::size_t i = 0; i < 2; ++i) joints[i] = pose.tip[i] - tool.p[i];
    return KinematicsStatus::Ok;
  }
  void jacobian(std::span<const double>, const Frame&, std::span<double> jacobian) const noexcept override {
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    jacobian[0] = jacobian[3] = 1;
  }
};

/// Three joints; the first two share two motors (sum and difference, as on a differential slide), the third has one.
class DifferentialMap : public ActuatorMap {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 3; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> q, std::span<double> a) const noexcept override {
    a[0] = q[0] + q[1];
    a[1] = q[0] - q[1];
    a[2] = q[2];
  }
  void joint_positions(std::span<const double> a, std::span<double> q) const noexcept override {
    q[0] = (a[0] + a[1]) / 2;
    q[1] = (a[0] - a[1]) / 2;
    q[2] = a[2];
  }
  void joint_velocities(std::span<const double>, std::span<const double> ad,
                        std::span<double> qd) const noexcept override {
    joint_positions(ad, qd);
  }
  void actuator_efforts(std::span<const double>, std::span<const double> e,
                        std::span<double> t) const noexcept override {
    t[0] = (e[0] + e[1]) / 2;
    t[1] = (e[0] - e[1]) / 2;
    t[2] = e[2];
  }
};

/// Three joints, one motor each, 1 rad a mm and 1 N·m a N, so that numbers can be read off.
class DirectMap : public ActuatorMap {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 3; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> q, std::span<double> a) const noexcept override { copy(q, a); }
  void joint_positions(std::span<const double> a, std::span<double> q) const noexcept override { copy(a, q); }
  void joint_velocities(std::span<const double>, std::span<const double> ad,
                        std::span<double> qd) const noexcept override {
    copy(ad, qd);
  }
  void actuator_efforts(std::span<const double>, std::span<const double> e,
                        std::span<double> t) const noexcept override {
    copy(e, t);
  }

 private:
  static void copy(std::span<const double> from, std::span<double> to) noexcept {
    std::copy(from.begin(), from.begin() + 3, to.begin());
  }
};

/// Two joints; the first has two motors that turn against each other and push together, 0 and 2, and 2 rad a mm.
class GantryMap : public ActuatorMap {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 2; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> q, std::span<double> a) const noexcept override {
    a[0] = 2 * q[0];
    a[1] = q[1];
    a[2] = -2 * q[0];
  }
  void joint_positions(std::span<const double> a, std::span<double> q) const noexcept override {
    q[0] = (a[0] - a[2]) / 4;
    q[1] = a[1];
  }
  void joint_velocities(std::span<const double>, std::span<const double> ad,
                        std::span<double> qd) const noexcept override {
    joint_positions(ad, qd);
  }
  void actuator_efforts(std::span<const double>, std::span<const double> e,
                        std::span<double> t) const noexcept override {
    t[0] = e[0] / 4;
    t[1] = e[1];
    t[2] = -e[0] / 4;
  }
};

/// Proportional law with a bias that `engage` sets; remembers what it saw.
class RecordingLaw : public ServoLaw {
 public:
  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return {}; }
  [[nodiscard]] bool set_gains(std::span<const double>) noexcept override { return true; }
  void set_effort_limit(double effort) noexcept override { limit = effort; }
  [[nodiscard]] double resting_effort() const noexcept override { return resting; }
  void engage(const ServoInput& input, double effort) noexcept override {
    ++engaged;
    bias = effort - gain * (input.position_setpoint - input.position);
  }
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    last = input;
    return answer_nan ? std::nan("") : gain * (input.position_setpoint - input.position) + bias;
  }
  double gain = 0.1;
  double bias = 0;
  double limit = 0;
  double resting = 0;
  int engaged = 0;
  bool answer_nan = false;
  ServoInput last;
};

/// Drives that take every CiA 402 transition at once and stand where the test puts them.
class FakeBus : public DigitalControlInterface {
 public:
  explicit FakeBus(std::size_t axes) : drives(axes) {}
  [[nodiscard]] std::size_t axis_count() const noexcept override { return drives.size(); }
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    for (std::size_t i = 0; i < drives.size(); ++i) feedback[i] = drives[i].words;
    return works;
  }
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    ++exchanges;
    for (std::size_t i = 0; i < drives.size(); ++i) {
      drives[i].command = commands[i];
      if (!drives[i].stuck) drives[i].words.statusword = next(drives[i].words.statusword, commands[i].controlword);
    }
    return works && sends;
  }
  [[nodiscard]] int answer_delay(std::size_t axis) const noexcept override { return delays.at(axis); }
  [[nodiscard]] bool tells_torque(std::size_t axis) const noexcept override { return (torque_told >> axis & 1U) != 0; }
  [[nodiscard]] bool tells_load(std::size_t axis) const noexcept override { return (loads_told >> axis & 1U) != 0; }
  [[nodiscard]] bool takes_torque_offset(std::size_t /*axis*/) const noexcept override { return torque_offset; }

  struct Drive {
    DriveFeedback words{.statusword = 0x40, .online = true};
    DriveCommand command;
    bool stuck = false;
  };
  std::vector<Drive> drives;
  bool works = true, sends = true;
  bool torque_offset = false;  ///< they take one beside what they follow
  std::array<int, kMaxJoints> delays{};
  std::uint32_t torque_told = 0;  ///< bit i: the answers of axis i hold its torque
  std::uint32_t loads_told = 0;   ///< and where its load is
  int exchanges = 0;

 private:
  static std::uint16_t next(std::uint16_t status, std::uint16_t control) noexcept {
    if (status == 0x08) return (control & controlword::kFaultReset) != 0 ? 0x40 : 0x08;
    if ((control & controlword::kEnableVoltage) == 0) return 0x40;
    if ((control & controlword::kNoQuickStop) == 0) return status == 0x27 || status == 0x07 ? 0x07 : 0x40;
    if (status == 0x40) return (control & controlword::kSwitchOn) == 0 ? 0x21 : 0x40;
    if (status == 0x21) return (control & controlword::kSwitchOn) != 0 ? 0x23 : 0x21;
    if (status == 0x23) return (control & controlword::kEnableOperation) != 0 ? 0x27 : 0x23;
    return status;
  }
};

/// Two joints, one held joint, three motors, a spindle (bus axis 3), and an axis that nobody uses.
class ServoLoopTest : public testing::Test {
 protected:
  ServoLoopParts parts(std::shared_ptr<const ActuatorMap> map = std::make_shared<DirectMap>()) {
    ServoLoopParts result;
    result.kinematics = std::make_shared<PlaneKinematics>();
    result.actuator_map = std::move(map);
    for (std::size_t j = 0; j < 3; ++j) {
      laws[j] = std::make_shared<RecordingLaw>();
      result.joints.push_back({laws[j], ControlMethod::Position, 1, 5});
      result.actuators.push_back({bus, static_cast<std::uint32_t>(j), kScale});
    }
    result.spindles.push_back({bus, 3, 1000});
    result.enable_timeout_s = 0.05;
    return result;
  }

  void build() { build(parts()); }
  void build(ServoLoopParts from) {
    auto made = ServoLoop::create(std::move(from));
    ASSERT_TRUE(made.has_value()) << made.error().message;
    loop = std::move(*made);
  }

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) loop->cycle(command, report);
  }
  /// Powers up; the setpoint of the joints is where they stand.
  void engage() {
    command.power = true;
    for (int i = 0; i < 20 && !report.follows; ++i) {
      cycle();
      for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
    }
    ASSERT_EQ(report.state, ServoState::Engaged);
    ASSERT_TRUE(report.follows);
  }
  void put_at(std::size_t axis, double mm) {
    fake->drives[axis].words.position_counts =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(mm * kCountsPerMm)));
  }
  [[nodiscard]] int torque(std::size_t axis) const { return bus->commands[axis].target_torque_permille; }
  void expect_all_quick_stopped() const {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      EXPECT_EQ(bus->commands[axis].controlword & controlword::kNoQuickStop, 0) << "axis " << axis;
      EXPECT_EQ(bus->commands[axis].target_torque_permille, 0) << "axis " << axis;
      EXPECT_EQ(bus->commands[axis].target_velocity_rpm, 0) << "axis " << axis;
    }
  }

  // 1 rad a mm, so a turn is 2π mm.
  static constexpr DriveScale kScale{2 * std::numbers::pi * kCountsPerMm, kRatedNm, 1, 0};
  std::shared_ptr<FakeBus> fake = std::make_shared<FakeBus>(5);
  std::shared_ptr<ServoBus> bus = std::make_shared<ServoBus>(fake);
  std::array<std::shared_ptr<RecordingLaw>, 3> laws;
  std::unique_ptr<ServoLoop> loop;
  ServoCommand command;
  ServoReport report;
};

}  // namespace rmac::servo_test
