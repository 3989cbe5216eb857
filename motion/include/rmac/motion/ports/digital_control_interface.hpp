#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "rmac/motion/error.hpp"

namespace rmac {

/// What a drive makes of a command (CiA 402 modes of operation, object 6060h).
enum class DriveMode : std::int8_t {
  None = 0,
  ProfilePosition = 1,
  ProfileVelocity = 3,
  ProfileTorque = 4,
  Homing = 6,
  InterpolatedPosition = 7,
  CyclicSyncPosition = 8,
  CyclicSyncVelocity = 9,
  CyclicSyncTorque = 10,
};

/// Words to one drive in one cycle, with CiA 402's meaning whatever bus carries them.
struct DriveCommand {
  std::uint16_t controlword = 0;            ///< 6040h
  DriveMode mode = DriveMode::None;         ///< 6060h
  std::int16_t target_torque_permille = 0;  ///< 6071h, of the drive's rated torque
  std::int32_t target_position_counts = 0;  ///< 607Ah; 60C1h:01 in interpolated position
  double target_velocity_rpm = 0;           ///< 60FFh
  double velocity_offset_rpm = 0;           ///< 60B1h, beside a position
  std::int16_t torque_offset_permille = 0;  ///< 60B2h, beside a position or a velocity
  std::uint16_t touch_probe = 0;            ///< 60B8h
  bool read_position = false;  ///< 6064h is to be read by a service of its own, beside the answers of the cycle
};

/// Words from one drive.
struct DriveFeedback {
  std::uint16_t statusword = 0;      ///< 6041h
  std::uint16_t error_code = 0;      ///< 603Fh
  std::int32_t position_counts = 0;  ///< 6064h; wraps
  std::int32_t load_counts = 0;      ///< 60E4h, where the load is, for who `tells_load`; no loop closes over it
  std::int32_t velocity_rpm = 0;     ///< 606Ch; spindles
  std::int16_t torque_permille = 0;  ///< 6077h
  DriveMode mode = DriveMode::None;  ///< 6061h; None where the interface does not tell
  bool online = false;               ///< the drive answered in this cycle
  bool missed = false;               ///< or it did not, which may happen, and the words are those of a cycle before
  std::uint32_t position_reads = 0;  ///< how often `read_position` was done, and what was found last
  std::int32_t position_read_counts = 0;
  std::int32_t sensor_counts = 0;  ///< a sensor beside the drive, such as one of force
  bool sensor_valid = false;       ///< there is one, and its value is good
  std::uint32_t inputs = 0;        ///< 60FDh
  std::uint16_t touch_probe = 0;   ///< 60B9h
  /// Positions that an edge of a touch probe latched: 60BAh to 60BDh, in the order of `TouchProbeEdge`.
  std::array<std::int32_t, 4> latched_counts{};
};

inline constexpr int kMostAnswerDelay = 8;  ///< cycles

/// An edge of a drive's touch probe input that latches its position.
enum class TouchProbeEdge : std::uint8_t { FirstRising, FirstFalling, SecondRising, SecondFalling };

/// Bits of 60B8h and 60B9h (CiA 402-2, touch probe) for one edge.
namespace touch_probe {
[[nodiscard]] constexpr unsigned shift_of(TouchProbeEdge edge) noexcept {
  return edge >= TouchProbeEdge::SecondRising ? 8 : 0;
}
[[nodiscard]] constexpr bool falls(TouchProbeEdge edge) noexcept {
  return edge == TouchProbeEdge::FirstFalling || edge == TouchProbeEdge::SecondFalling;
}
/// Function: the probe is enabled, its input is the trigger, and the first such edge after this latches.
[[nodiscard]] constexpr std::uint16_t latch_once(TouchProbeEdge edge) noexcept {
  return static_cast<std::uint16_t>((falls(edge) ? 0x21U : 0x11U) << shift_of(edge));
}
/// Status: the edge has latched a position.
[[nodiscard]] constexpr std::uint16_t latched(TouchProbeEdge edge) noexcept {
  return static_cast<std::uint16_t>((falls(edge) ? 0x04U : 0x02U) << shift_of(edge));
}
}  // namespace touch_probe

/// Port: the drives of one bus. An axis is the place of one drive on it, as `Axis` in `device.json` counts them from 0;
/// which joint its motor moves is not known here. Lives in the gateway's bus registry and outlives mechanisms, which
/// borrow axes of it.
class DigitalControlInterface {
 public:
  virtual ~DigitalControlInterface() = default;
  [[nodiscard]] virtual std::size_t axis_count() const noexcept = 0;
  /// Brings the bus up; the error names the node that is missing and how long was waited. Off the cycle.
  [[nodiscard]] virtual Expected<> start() = 0;
  /// Leaves every drive disabled. Off the cycle; cannot fail.
  virtual void stop() noexcept = 0;
  /// What the drives tell, axis_count() of them: once a cycle, at its begin. Never waits for them. False when the bus
  /// itself failed. Real-time safe.
  [[nodiscard]] virtual bool receive(std::span<DriveFeedback> feedback) noexcept = 0;
  /// What they are to do, which was made of what `receive` told in the same cycle; axis_count() of them, once a cycle.
  /// False when the bus itself failed. Real-time safe.
  [[nodiscard]] virtual bool send(std::span<const DriveCommand> commands) noexcept = 0;
  /// Both, for who makes its commands of what was told a cycle before.
  [[nodiscard]] bool exchange(std::span<const DriveCommand> commands, std::span<DriveFeedback> feedback) noexcept {
    const bool received = receive(feedback);
    return send(commands) && received;
  }
  /// The mode in which this axis, of a joint or a spindle, follows its setpoints. Before or after start.
  [[nodiscard]] virtual DriveMode mode(std::size_t /*axis*/) const noexcept { return DriveMode::CyclicSyncTorque; }
  /// Bits of `DriveFeedback::inputs` that this axis tells: a name for another one is a mistake.
  [[nodiscard]] virtual std::uint32_t input_bits(std::size_t /*axis*/) const noexcept { return 0; }
  /// Position counts in one turn of the motor, as its drive says itself; 0 where it does not. Once started.
  [[nodiscard]] virtual double counts_per_revolution(std::size_t /*axis*/) const noexcept { return 0; }
  /// Whether the answers of this axis hold its torque (6077h).
  [[nodiscard]] virtual bool tells_torque(std::size_t /*axis*/) const noexcept { return false; }
  /// Whether the answers of this axis hold where its load truly is, whatever its encoder says: simulated axes alone.
  [[nodiscard]] virtual bool tells_load(std::size_t /*axis*/) const noexcept { return false; }
  /// How many cycles before `receive` this axis was where it tells in it, at most `kMostAnswerDelay`: 1 where the SYNC
  /// of one cycle has the drives measure, and the next cycle receives what they answered; more where a drive itself
  /// takes its time. Once started.
  [[nodiscard]] virtual int answer_delay(std::size_t /*axis*/) const noexcept { return 0; }
  /// Whether `DriveCommand::torque_offset_permille` reaches this axis, in a mode that has it.
  [[nodiscard]] virtual bool takes_torque_offset(std::size_t /*axis*/) const noexcept { return false; }
  /// Whether this axis does `DriveCommand::read_position`.
  [[nodiscard]] virtual bool reads_positions(std::size_t /*axis*/) const noexcept { return false; }
  /// Whether this axis can latch its position at `edge`.
  [[nodiscard]] virtual bool latches(std::size_t /*axis*/, TouchProbeEdge /*edge*/) const noexcept { return false; }
};

}  // namespace rmac
