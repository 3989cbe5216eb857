#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"
#include "rmac/motion/ports/servo_law.hpp"

namespace rmac {

struct ServoBus;

/// A drive that turns a spindle: it follows a speed itself, or gives the torque that a law asks for.
struct ServoSpindle {
  std::shared_ptr<ServoBus> bus;
  std::uint32_t axis = 0;  ///< of the bus
  double max_speed_rpm = 0;
  DriveMode mode = DriveMode::ProfileVelocity;  ///< or cyclic synchronous velocity or torque
  /// Gains set; the loop sets the effort limit. Where the drive takes a torque, and only there.
  std::shared_ptr<ServoLaw> law{};
  /// `Velocity`: the law is told rpm and rpm/s where a joint's is told positions and velocities. `Position`: degrees,
  /// of an angle that turns with the speed wanted and stands where that is 0.
  ControlMethod method = ControlMethod::Velocity;
  DriveScale scale{};                  ///< of a drive that takes a torque; the rated torque of one that measures it
  double max_acceleration_rpm_s = 0;   ///< of the speed that a drive in a cyclic mode is given
  double max_following_error_deg = 0;  ///< under `ControlMethod::Position`; beyond it the machine stops
  double max_torque_nm = 0;            ///< of the law; measured, for a tenth of a second at speed, the machine stops
  double speed_tolerance_rpm = 0;      ///< how near counts as at speed
  double speed_timeout_s = 0;          ///< after so long the torque is watched, whatever the speed
};

/// Whether its values fit each other and its drive; the error begins with `who`. Off the servo thread.
[[nodiscard]] Expected<> check_spindle(const ServoSpindle& spindle, const std::string& who);

}  // namespace rmac
