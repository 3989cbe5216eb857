#include <cmath>

#include "rmac/motion/frame.hpp"
#include "servo/servo_loop_impl.hpp"

namespace rmac {

void ServoLoop::Impl::fill_drives(ServoReport& report) const noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    const DriveFeedback& words = feedback(i);
    report.statusword[i] = words.statusword;
    report.error_code[i] = words.error_code;
    report.torque_permille[i] = words.torque_permille;
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    report.spindle_statusword[i] = spindle_feedback(i).statusword;
    report.spindle_rpm[i] = spindles[i].rpm();
    report.spindle_torque_nm[i] = spindles[i].torque_nm();
  }
}

void ServoLoop::Impl::fill(const ServoCommand& command, ServoReport& report) const noexcept {
  report.state = state;
  report.follows = follows;
  report.fault = fault;
  report.homings = homings;
  report.probe = probe_report();
  report.position_set = hold;
  report.velocity_set = set_velocity;
  report.acceleration_set = set_acceleration;
  report.position = position;
  report.velocity = velocity;
  report.effort = effort;
  report.force = force;
  for (std::size_t j = 0; j < axes; ++j) {
    const bool by_force = parts.axes[j].method == ControlMethod::Force && live[j];
    report.contact[j] = by_force ? force_loops[j].state() : ContactState::None;
  }
  if (!parts.virtual_mode) {
    fill_drives(report);
  } else {
    report.spindle_rpm = driving() ? command.spindle_rpm : decltype(command.spindle_rpm){};
  }

  const std::span<const double> measured(position.data(), joints);
  ToolPose in_machine;
  parts.kinematics->forward(measured, command.frames.tool, in_machine);
  report.pose = apply_to_pose(inverse(command.frames.part), in_machine);
  std::array<double, 6 * kMaxJoints> jacobian{};
  parts.kinematics->jacobian(measured, command.frames.tool, {jacobian.data(), 6 * joints});
  double squared = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double component = 0;
    for (std::size_t j = 0; j < joints; ++j) component += jacobian[row * joints + j] * velocity[j];
    squared += component * component;
  }
  report.feed_mm_s = std::sqrt(squared);
}

}  // namespace rmac
