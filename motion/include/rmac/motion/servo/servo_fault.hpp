#pragma once

#include <cstdint>

namespace rmac {

/// How motion ends, as IEC 60204-1 (9.2.2) numbers it; category 0, power off at once, is the hardware's. Which one a
/// machine needs follows from its risk assessment.
enum class StopCategory : std::uint8_t {
  StopThenRemovePower = 1,  ///< drives brake by themselves, and lose their power as they come to rest
  StopKeepPower = 2,        ///< the servo loop brakes every joint in step, and holds it
};

enum class ServoState : std::uint8_t {
  Off,        ///< no torque
  Enabling,   ///< drives are on their way to Operation Enabled; those that are there hold their position
  Engaged,    ///< every joint follows its setpoint
  Homing,     ///< some drives look for home by themselves, and the other joints hold their position
  QuickStop,  ///< asked for: drives brake by themselves
  Faulted,    ///< stopping or stopped because of `fault`, as its category says; left by a reset
};

/// What is wrong, first cause first. `index` counts joints (held ones included), actuators, spindles or buses, as
/// `part` says.
struct ServoFault {
  enum class Kind : std::uint8_t {
    None,
    FollowingError,  ///< value: the error, bound: what is allowed (mm or deg)
    VelocityBound,   ///< value: the measured velocity, bound: what is allowed (mm/s or deg/s; of a spindle rpm)
    TorqueBound,     ///< value: the torque that the drive measures, bound: what is allowed (N·m); of a spindle too
    Oscillation,  ///< a joint's loop swings; value: Hz, as the cycles show it, bound: amplitude of its effort (N, N·m)
    WrongDirection,  ///< a joint goes faster and faster against its effort; value: the way, bound: the effort (N, N·m)
    StandsStill,     ///< a joint is to move, and its position stays; value: the way that it was to go (mm or deg),
                     ///< bound: for how many seconds it stands
    EncoderFrozen,   ///< an encoder of a joint tells the same to the last digit; value: for how many seconds, bound: by
                     ///< how much the effort changed meanwhile (N, N·m)
    Skewed,          ///< motors of one joint went apart, and this one lags; value: by how far they are (mm or deg of
                     ///< the joint), bound: what is allowed
    EncoderJump,     ///< value: the jump, bound: what motion can explain within a cycle (mm or deg)
    Displaced,    ///< a joint is not where it was left, or not where it would be sent; value: how far it is from there,
                  ///< bound: what is allowed (mm or deg)
    SensorLost,   ///< a joint's force sensor gives no valid value, or a drive reports its encoder gone
    ForceLimit,   ///< value: the measured force, bound: what is allowed (N or N·m)
    ContactLost,  ///< a joint found nothing to push against; value: the way it went, bound: what is allowed
    CyclesLost,   ///< value: deadlines missed within a second, bound: what is allowed
    NotANumber,   ///< a law or a setpoint gave NaN or infinity
    DriveFault,   ///< value: the drive's error code (603Fh)
    DriveOffline,   ///< the drive did not answer
    DriveDropped,   ///< the drive left Operation Enabled by itself; value: its statusword
    EnableTimeout,  ///< value: the statusword it is stuck at, bound: seconds waited
    BusFailure,
    IoFailure,
    EmergencyStop,  ///< index: the input; told whatever else is wrong
    LimitSwitch,    ///< index: the input
    HomingFailed,   ///< value: the drive's statusword; bound: seconds waited, 0 when the drive gave up
  };
  enum class Part : std::uint8_t { Joint, Actuator, Spindle, Bus, Io, Clock };
  Kind kind = Kind::None;
  Part part = Part::Joint;
  std::uint32_t index = 0;
  double value = 0;
  double bound = 0;
  StopCategory stop = StopCategory::StopThenRemovePower;  ///< how the machine stops, or stopped
};

/// How the machine stops on what a category may be chosen for. A stop that keeps power rests on the drives and on the
/// measured positions, so there is no choice where one of them may be what is wrong: a joint that does not follow can
/// be blocked, or have an encoder that stands still. A drive that falls silent leaves a choice where nothing but a
/// spindle or a joint of its own hangs on it: the rest brakes without it.
struct StopCategories {
  StopCategory sensor_lost = StopCategory::StopThenRemovePower;
  StopCategory force_limit = StopCategory::StopThenRemovePower;
  StopCategory contact_lost = StopCategory::StopKeepPower;
  StopCategory spindle_overload = StopCategory::StopKeepPower;
  StopCategory cycles_lost = StopCategory::StopThenRemovePower;
  StopCategory drive_silent = StopCategory::StopKeepPower;
};

[[nodiscard]] const char* to_string(ServoState state) noexcept;
[[nodiscard]] const char* to_string(ServoFault::Kind kind) noexcept;

}  // namespace rmac
