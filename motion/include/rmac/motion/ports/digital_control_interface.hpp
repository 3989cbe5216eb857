#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rmac/motion/error.hpp"

namespace rmac {

/// What a drive makes of a command (CiA 402 modes of operation, object 6060h).
enum class DriveMode : std::int8_t {
  None = 0,
  ProfileVelocity = 3,
  Homing = 6,
  CyclicSyncPosition = 8,
  CyclicSyncVelocity = 9,
  CyclicSyncTorque = 10,
};

/// Words to one drive in one cycle, with CiA 402's meaning whatever bus carries them.
struct DriveCommand {
  std::uint16_t controlword = 0;            ///< 6040h
  DriveMode mode = DriveMode::None;         ///< 6060h
  std::int16_t target_torque_permille = 0;  ///< 6071h, of the drive's rated torque
  std::int32_t target_position_counts = 0;  ///< 607Ah
  std::int32_t target_velocity_rpm = 0;     ///< 60FFh; spindles
};

/// Words from one drive.
struct DriveFeedback {
  std::uint16_t statusword = 0;      ///< 6041h
  std::uint16_t error_code = 0;      ///< 603Fh
  std::int32_t position_counts = 0;  ///< 6064h; wraps
  std::int32_t velocity_rpm = 0;     ///< 606Ch; spindles
  std::int16_t torque_permille = 0;  ///< 6077h
  DriveMode mode = DriveMode::None;  ///< 6061h; None where the interface does not tell
  bool online = false;               ///< the drive answered in this cycle
  std::int32_t sensor_counts = 0;    ///< a sensor beside the drive, such as one of force
  bool sensor_valid = false;         ///< there is one, and its value is good
};

/// Port: the drives of one bus, axis by axis. Lives in the gateway's bus registry and outlives mechanisms, which borrow
/// axes of it.
class DigitalControlInterface {
 public:
  virtual ~DigitalControlInterface() = default;
  [[nodiscard]] virtual std::size_t axis_count() const noexcept = 0;
  /// Brings the bus up; the error names the node that is missing and how long was waited. Off the cycle.
  [[nodiscard]] virtual Expected<> start() = 0;
  /// Leaves every drive disabled. Off the cycle; cannot fail.
  virtual void stop() noexcept = 0;
  /// One cycle: sends `commands`, receives `feedback`; axis_count() of each. False when the bus itself failed.
  /// Real-time safe.
  [[nodiscard]] virtual bool exchange(std::span<const DriveCommand> commands,
                                      std::span<DriveFeedback> feedback) noexcept = 0;
};

}  // namespace rmac
