#pragma once

#include "gateway/simulators/vdrive/axis.hpp"

namespace rmac::vdrive {

/// What the steps of one advance need of the dictionary.
struct Axis::Parameters {
  double velocity, acceleration, deceleration, quick_stop, homing_acceleration, fast, slow, top_velocity;
  double target_velocity, torque_slope, target_torque, most_torque, least_position, most_position;
  double window, window_s, velocity_window, velocity_window_s, error_window, error_s;
  double negative_limit, positive_limit, cam_from, cam_to, index, touches_from, touches_to;
  double home_offset, slow_velocity;
  OptionCodes options;
  Braking halting;
  int homing_method;
  std::uint16_t controlword;

  /// Bit 8 of the controlword.
  [[nodiscard]] bool halts() const { return (controlword & 0x0100) != 0; }
};

}  // namespace rmac::vdrive
