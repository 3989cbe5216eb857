#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {
namespace {

/// The circle of the figures, with drives that close the loops of position or velocity themselves.
class DrivesThatFollow : public MillRun {
 public:
  explicit DrivesThatFollow(DriveMode mode, double own_velocity = 1, double told_velocity = 0) : mode_(mode) {
    auto axes = fieldbus::default_simulated_axes();
    for (fieldbus::SimulatedAxis& axis : axes) {
      auto* servo = std::get_if<fieldbus::AxisPlantParameters>(&axis);
      if (servo == nullptr) continue;
      servo->mode = mode;
      servo->own_velocity = own_velocity;
      servo->told_velocity = told_velocity;
    }
    simulated_ = std::make_shared<fieldbus::SimulatedInterface>(axes, 0.001);
    bus_ = std::make_shared<ServoBus>(simulated_);
  }
  /// Without a law, or with so much of the axes' model beside the drives' loops.
  Ballbar measure(std::optional<double> model_share) {
    constexpr double kLead_s = 0.0005;  // the torque acts in the cycle that begins: half of it
    return measure_circle(
        [&](nlohmann::json& device) {
          if (model_share) choose_feedforward(device, *model_share, kLead_s);
        },
        [&](Mill&, ServoLoopParts& parts) {
          for (ServoActuator& actuator : parts.actuators) {
            actuator.mode = mode_;
            if (mode_ == DriveMode::CyclicSyncVelocity) actuator.position_gain = 20;
          }
          for (ServoJoint& joint : parts.joints) {
            if (!model_share) joint.law = nullptr;
            joint.max_following_error = 2;  // 100 mm/s behind a position loop of 150 1/s, without a velocity
          }
        });
  }

 private:
  DriveMode mode_;
};

class TorqueOffsetsOnMill : public testing::TestWithParam<DriveMode> {};

// Red where the torque does not reach the drive's loop, or has another sign or moment.
TEST_P(TorqueOffsetsOnMill, LeaveTheDrivesLoopsAFractionOfTheReversalSpike) {
  const auto measure = [](const char* name, std::optional<double> model_share) {
    const Ballbar ballbar = DrivesThatFollow(GetParam()).measure(model_share);
    RecordProperty(std::string(name) + "_contour_error_um", std::to_string(ballbar.contour_error() * 1e3));
    RecordProperty(std::string(name) + "_reversal_spike_um", std::to_string(ballbar.reversal_spike() * 1e3));
    return ballbar.reversal_spike();
  };
  const double alone = measure("alone", std::nullopt);
  EXPECT_LT(measure("beside", 1), alone / 2);
  EXPECT_LT(measure("tenth_too_small", 0.9), alone / 1.5);
}

// Red where the velocity (60B1h) is of another cycle, sign or unit than the positions, or does not go beside a torque.
TEST(VelocityOffsetsOnMill, DoForDrivesWithoutAVelocityOfTheirOwnWhatOthersDoThemselves) {
  const auto measure = [](const char* name, double told_velocity, std::optional<double> model_share) {
    const Ballbar ballbar = DrivesThatFollow(DriveMode::CyclicSyncPosition, 0, told_velocity).measure(model_share);
    testing::Test::RecordProperty(std::string(name) + "_contour_error_um",
                                  std::to_string(ballbar.contour_error() * 1e3));
    testing::Test::RecordProperty(std::string(name) + "_reversal_spike_um",
                                  std::to_string(ballbar.reversal_spike() * 1e3));
    return ballbar.contour_error();
  };
  const double alone = measure("alone", 0, std::nullopt);
  const double torque = measure("torque", 0, 1);
  const double velocity = measure("velocity", 1, std::nullopt);
  const double both = measure("both", 1, 1);
  EXPECT_LT(velocity, alone / 1.5);
  EXPECT_LT(both, torque / 4);
  EXPECT_LT(both, velocity / 4);
}

INSTANTIATE_TEST_SUITE_P(Of, TorqueOffsetsOnMill,
                         testing::Values(DriveMode::CyclicSyncPosition, DriveMode::CyclicSyncVelocity),
                         [](const auto& mode) {
                           return mode.param == DriveMode::CyclicSyncPosition ? "Position" : "Velocity";
                         });

}  // namespace
}  // namespace rmac::mill_test
