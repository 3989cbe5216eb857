#pragma once

#include <cstdint>

#include "gateway/simulators/vdrive/axis/axis_units.hpp"
#include "gateway/simulators/vdrive/axis/power_states.hpp"
#include "gateway/simulators/vdrive/objects/dictionary.hpp"
#include "rmac/fieldbus/simulated_plant.hpp"

namespace rmac::vdrive {

/// What the shaft passes on its way (2000h of this drive), as angles in counts from where it stood at power on.
struct AxisSwitches {
  double negative_limit, positive_limit, cam_from, cam_to, index, touches_from, touches_to;

  // What closes where the shaft is there.
  [[nodiscard]] bool at_negative_limit(double angle) const { return angle <= negative_limit; }
  [[nodiscard]] bool at_positive_limit(double angle) const { return angle >= positive_limit; }
  [[nodiscard]] bool in_cam(double angle) const { return angle >= cam_from && angle <= cam_to; }
  [[nodiscard]] bool touches(double angle) const { return angle >= touches_from && angle <= touches_to; }
};

/// What a drive's steps need of the dictionary, in counts of the encoder, seconds and N·m.
struct AxisParameters {
  double velocity, acceleration, deceleration, quick_stop, homing_acceleration, fast, slow, top_velocity;
  double target_velocity, torque_slope, target_torque, torque_offset, velocity_offset, own_velocity, most_torque,
      least_position, most_position;
  double window, window_s, velocity_window, velocity_window_s, error_window, error_s;
  double home_offset, slow_velocity;
  AxisSwitches switches;
  OptionCodes options;
  Braking halting;
  int homing_method;
  std::uint16_t controlword;

  /// Bit 8 of the controlword.
  [[nodiscard]] bool halts() const { return (controlword & 0x0100) != 0; }
};

/// The parameters as the dictionary has them now.
[[nodiscard]] AxisParameters read_parameters(const Dictionary& dictionary, const AxisUnits& units,
                                             const fieldbus::AxisPlantParameters& mechanics);

}  // namespace rmac::vdrive
