#include <cmath>

#include "rmac/motion/frame.hpp"
#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

/// Where the tool is and how fast its tip goes, from measured joints.
void fill_tool(const Kinematics& kinematics, const Frames& frames, std::span<const double> position,
               std::span<const double> velocity, ServoReport& report) noexcept {
  const std::size_t joints = position.size();
  report.pose = apply_to_pose(inverse(frames.part), pose_of(kinematics, position, frames.tool));
  report.feed_mm_s = 0;
  if (!kinematics.has_pose(position)) return;
  std::array<double, 6 * kMaxJoints> jacobian{};
  kinematics.jacobian(position, frames.tool, {jacobian.data(), 6 * joints});
  double squared = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double component = 0;
    for (std::size_t j = 0; j < joints; ++j) component += jacobian[row * joints + j] * velocity[j];
    squared += component * component;
  }
  report.feed_mm_s = std::sqrt(squared);
}

}  // namespace

void ServoLoop::Impl::fill(const ServoCommand& command, ServoReport& report) const noexcept {
  report.state = state.state();
  report.follows = state.follows();
  report.fault = state.fault();
  report.inputs = inputs.inputs();
  report.exchange_ns = exchange.took_ns();
  report.homings = homing.completed();
  report.reference_lost = positions.lost();
  report.probe = probe.report(shafts, transmission);
  report.position_set = setpoints.position();
  report.velocity_set = setpoints.velocity();
  report.acceleration_set = setpoints.acceleration();
  report.position = joints.position();
  report.answer_delay = parts.virtual_mode ? Wiring::Delays{} : wiring.joint_delays();
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    report.following_error[j] = setpoints.following_error(j, joints.position()[j]);
  }
  report.velocity = joints.velocity();
  report.force = joints.force();
  report.effort = laws.effort();
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    const bool by_force = parts.joints[j].method == ControlMethod::Force && live[j];
    report.contact[j] = by_force ? setpoints.force_loop(j).state() : ContactState::None;
  }
  if (parts.virtual_mode) {
    report.spindle_rpm = state.driving() ? command.spindle_rpm : decltype(command.spindle_rpm){};
  } else {
    for (std::size_t i = 0; i < wiring.actuators(); ++i) {
      const DriveFeedback& words = told(i);
      report.statusword[i] = words.statusword;
      report.error_code[i] = words.error_code;
      report.torque_permille[i] = words.torque_permille;
      report.counts[i] = words.position_counts;
    }
    report.ahead = gantries.ahead();
    report.truth.reset();
    if (const auto loads = shafts.loads_rad()) {
      report.truth = joints.at_loads({loads->data(), wiring.actuators()});
    }
    spindles.fill(report);
  }
  const std::size_t kinematic = parts.kinematics->joint_count();
  fill_tool(*parts.kinematics, command.frames, joints.positions().first(kinematic),
            {joints.velocity().data(), kinematic}, report);
}

}  // namespace rmac
