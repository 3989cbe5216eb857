#include <random>

#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {
namespace {

/// The simulated bus with the phases of one motor exchanged: it turns against its torque, and its drive does not know.
class ReversedMotor final : public DigitalControlInterface {
 public:
  explicit ReversedMotor(std::shared_ptr<fieldbus::SimulatedInterface> bus) : bus_(std::move(bus)) {}
  [[nodiscard]] std::size_t axis_count() const noexcept override { return bus_->axis_count(); }
  [[nodiscard]] Expected<> start() override { return bus_->start(); }
  void stop() noexcept override { bus_->stop(); }
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    const bool works = bus_->receive(feedback);
    feedback[0].torque_permille = static_cast<std::int16_t>(-feedback[0].torque_permille);
    return works;
  }
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    std::copy(commands.begin(), commands.end(), turned_.begin());
    turned_[0].target_torque_permille = static_cast<std::int16_t>(-turned_[0].target_torque_permille);
    return bus_->send({turned_.data(), commands.size()});
  }
  [[nodiscard]] DriveMode mode(std::size_t axis) const noexcept override { return bus_->mode(axis); }
  [[nodiscard]] bool tells_torque(std::size_t axis) const noexcept override { return bus_->tells_torque(axis); }

 private:
  std::shared_ptr<fieldbus::SimulatedInterface> bus_;
  std::array<DriveCommand, 64> turned_{};
};

TEST(ResponseOnMill, NamesAReversedMotorWithin10MsOfItsEffort) {
  const auto simulated = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001);
  Mill mill("mill/3-axis/DMACXYZ", std::make_shared<ServoBus>(std::make_shared<ReversedMotor>(simulated)));
  ServoCommand command;
  ServoReport report;
  command.power = true;
  const double start = simulated->plant(0).angle_rad();
  int since_effort = 0;
  for (int i = 0; i < 3000 && report.fault.kind == ServoFault::Kind::None; ++i) {
    if (!report.follows) {
      const std::span<const double> hold = mill.loop().hold_position();
      std::copy(hold.begin(), hold.end(), command.setpoint.position.begin());
    } else {
      command.setpoint.position[0] += 0.001;
    }
    mill.loop().cycle(command, report);
    if (since_effort > 0 || std::abs(report.effort[0]) > 0.25 * 800) ++since_effort;
  }
  EXPECT_STREQ(to_string(report.fault.kind), "WrongDirection");
  EXPECT_EQ(report.fault.index, 0U);
  EXPECT_LE(since_effort, 10);
  EXPECT_LT(std::abs(simulated->plant(0).angle_rad() - start) * 5 / (2 * std::numbers::pi), 0.5);
}

// What a cutter or a hand does within anything from a cycle to a fifth of a second: the loop gives way and comes back.
TEST(ResponseOnMill, TakesNoPushForAReversedMotor) {
  constexpr double kNmPerN = 5e-3 / (2 * std::numbers::pi);
  std::mt19937_64 random(8);
  const auto between = [&](double least, double most) { return std::uniform_real_distribution<>(least, most)(random); };
  for (int k = 0; k < 200; ++k) {
    const auto simulated = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001);
    Mill mill("mill/3-axis/DMACXYZ", std::make_shared<ServoBus>(simulated));
    ServoCommand command;
    ServoReport report;
    command.power = true;
    const double newton = between(-400, 400), rise = std::pow(10, between(0, 2.3)),
                 speed = k % 2 == 0 ? 0 : between(-20, 20);
    int pushed = 0;
    for (int i = 0; i < 3000 && pushed < 600 && report.fault.kind == ServoFault::Kind::None; ++i) {
      if (!report.follows) {
        const std::span<const double> hold = mill.loop().hold_position();
        std::copy(hold.begin(), hold.end(), command.setpoint.position.begin());
      } else {
        command.setpoint.position[0] += speed * 0.001;
        command.setpoint.velocity[0] = speed;
        if (++pushed > 100) simulated->push(0, newton * kNmPerN * std::min(1.0, (pushed - 100) / rise));
      }
      mill.loop().cycle(command, report);
    }
    EXPECT_EQ(pushed, 600) << "pushed by " << newton << " N within " << rise << " ms, at " << speed
                           << " mm/s: " << to_string(report.fault.kind);
  }
}

TEST(ResponseOnMill, NamesAnEncoderThatStandsStill) {
  const auto simulated = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001);
  Mill mill("mill/3-axis/DMACXYZ", std::make_shared<ServoBus>(simulated));
  ServoCommand command;
  ServoReport report;
  command.power = true;
  for (int i = 0; i < 3000 && report.fault.kind == ServoFault::Kind::None; ++i) {
    if (!report.follows) {
      const std::span<const double> hold = mill.loop().hold_position();
      std::copy(hold.begin(), hold.end(), command.setpoint.position.begin());
    } else {
      command.setpoint.position[1] += 0.01;
      command.setpoint.velocity[1] = 10;
      if (i == 500) simulated->freeze_encoder(1, true);
    }
    mill.loop().cycle(command, report);
  }
  EXPECT_STREQ(to_string(report.fault.kind), "StandsStill");
  EXPECT_EQ(report.fault.index, 1U);
}

}  // namespace
}  // namespace rmac::mill_test
