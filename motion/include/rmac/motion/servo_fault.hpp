#pragma once

#include <cstdint>

namespace rmac {

enum class ServoState : std::uint8_t {
  Off,        ///< no torque
  Enabling,   ///< drives are on their way to Operation Enabled; those that are there hold their position
  Engaged,    ///< every joint follows its setpoint
  Homing,     ///< some drives look for home by themselves, and the other joints hold their position
  QuickStop,  ///< asked for: drives brake by themselves
  Faulted,    ///< the same, because of `fault`; left by a reset
};

/// What is wrong, first cause first. `index` counts joints (held ones included), actuators, spindles or buses, as
/// `part` says.
struct ServoFault {
  enum class Kind : std::uint8_t {
    None,
    FollowingError,  ///< value: the error, bound: what is allowed (mm or deg)
    NotANumber,      ///< a law or a setpoint gave NaN or infinity
    DriveFault,      ///< value: the drive's error code (603Fh)
    DriveOffline,    ///< the drive did not answer
    DriveDropped,    ///< the drive left Operation Enabled by itself; value: its statusword
    EnableTimeout,   ///< value: the statusword it is stuck at, bound: seconds waited
    BusFailure,
    IoFailure,
    EmergencyStop,  ///< index: the input; told whatever else is wrong
    LimitSwitch,    ///< index: the input
    HomingFailed,   ///< value: the drive's statusword; bound: seconds waited, 0 when the drive gave up
  };
  enum class Part : std::uint8_t { Joint, Actuator, Spindle, Bus, Io };
  Kind kind = Kind::None;
  Part part = Part::Joint;
  std::uint32_t index = 0;
  double value = 0;
  double bound = 0;
};

[[nodiscard]] const char* to_string(ServoState state) noexcept;
[[nodiscard]] const char* to_string(ServoFault::Kind kind) noexcept;

}  // namespace rmac
