#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/axis.hpp"
#include "rmac/motion/force_control.hpp"
#include "rmac/motion/joint_mechanics.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/motion/servo_fault.hpp"
#include "rmac/motion/servo_spindle.hpp"
#include "rmac/motion/setpoint.hpp"

namespace rmac {

/// A bus with the words of all its axes. The bus registry owns it; servo loops share it one after the other.
struct ServoBus {
  explicit ServoBus(std::shared_ptr<DigitalControlInterface> bus_interface);
  std::shared_ptr<DigitalControlInterface> interface;
  std::vector<DriveCommand> commands;   ///< go out with the next exchange
  std::vector<DriveFeedback> feedback;  ///< came in with the last
};

/// Where a joint's force sensor is read: a word beside those of a drive, of this mechanism or not.
struct ServoForceSensor {
  std::shared_ptr<ServoBus> bus;
  std::uint32_t axis = 0;
  double newton_per_count = 0;
  std::int32_t zero_counts = 0;  ///< reading without force
};

/// What a joint's measured motion is held to, in mm and s, or degrees and s; 0: not watched.
struct JointBounds {
  double velocity = 0;           ///< beyond it for three cycles on end the machine stops
  double jump = 0;               ///< change of a position's step from cycle to cycle that no motion explains
  double stop_deceleration = 0;  ///< of a stop that keeps power; 0: the setpoint stands at once
  double min_position = -std::numeric_limits<double>::infinity();  ///< travel, where no plan keeps the joint in it
  double max_position = std::numeric_limits<double>::infinity();
};

/// The loop of one joint.
struct ServoAxis {
  /// Gains set; the loop sets the effort limit. Null where the joint's drives close its loop themselves.
  std::shared_ptr<ServoLaw> law;
  ControlMethod method = ControlMethod::Position;
  double max_following_error = 0;  ///< mm or deg
  double max_effort = 0;           ///< N or N·m at the joint
  JointMechanics mechanics{};      ///< made good between the law and the drive
  JointBounds bounds{};
  std::optional<ServoForceSensor> force_sensor{};
  ForceControl force{};  ///< used under `ControlMethod::Force`
};

/// A drive that moves joints: in torque mode, behind the law of its joint, or following the joint's setpoint itself.
struct ServoActuator {
  std::shared_ptr<ServoBus> bus;
  std::uint32_t axis = 0;
  DriveScale scale;
  std::uint8_t homing_turn = 0;  ///< in which its drive looks for home by itself, from 1; 0: it does not
  double max_torque_nm = 0;      ///< measured by the drive; beyond it for three cycles on end the machine stops; 0: not
                                 ///< watched
  /// Cyclic synchronous torque, velocity or position.
  DriveMode mode = DriveMode::CyclicSyncTorque;
  double position_gain = 0;  ///< 1/s: of the position loop that is closed here over a drive in velocity mode
  std::optional<TouchProbeEdge> probe_edge{};  ///< at which its drive latches the position of a hit
};

/// A digital input that a drive tells.
struct ServoDriveInput {
  std::uint32_t actuator = 0;
  std::uint32_t drive_bit = 0;  ///< mask, of the drive's inputs
  std::uint64_t input = 0;      ///< mask, of the machine's
};

/// A limit switch at one end of a joint's travel. While it is on the joint does not move on towards it.
struct ServoLimit {
  std::uint64_t input = 0;  ///< mask; one of `limit_inputs`
  std::uint32_t joint = 0;
  int direction = 0;  ///< 1: at the upper end; -1: at the lower one
};

/// A touch probe among the inputs.
struct ServoProbe {
  std::uint64_t touch_input = 0;  ///< its bit is 1 while the probe is deflected; 0: there is no probe
  std::uint64_t ready_input = 0;  ///< on while the probe has power; 0: it does not tell
  double settle_s = 0.005;        ///< a contact that opens for less has not let go: it bounces
};

/// What the probe tells in one cycle.
struct ProbeReport {
  bool ready = false;       ///< there is one, and it has power as far as it tells
  bool touching = false;    ///< from its first contact until it has let go for its settling time
  std::uint32_t hits = 0;   ///< first contacts so far; wraps
  double hit_before_s = 0;  ///< how long before the cycle's measurement the last one was, in the cycle that counts it
  std::uint32_t latching = 0;                         ///< bit i: the drives of joint i latch their positions at a hit
  std::uint32_t latched = 0;                          ///< bit i: they have, at the last one; until the probe has let go
  std::array<double, kMaxJoints> latched_position{};  ///< of those joints
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

/// What a servo loop is made of. `axes`: the kinematic joints, then the held ones; `actuators` in the order of the map.
struct ServoLoopParts {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const ActuatorMap> actuator_map;
  std::vector<ServoAxis> axes;
  std::vector<ServoActuator> actuators;
  std::vector<ServoSpindle> spindles;
  std::shared_ptr<DigitalIoInterface> io;  ///< may be null
  /// Inputs that stop all drives while any is on; a reset has to wait until they are off.
  std::uint64_t emergency_stop_inputs = 0;
  /// Inputs that stop all drives as they come on. A reset helps while they are on, so that the axis can be moved off.
  std::uint64_t limit_inputs = 0;
  std::vector<ServoLimit> limits;             ///< those of known joints and ends
  std::vector<ServoDriveInput> drive_inputs;  ///< inputs beside those of `io`
  ServoProbe probe{};
  double period_s = 0.001;
  double enable_timeout_s = 5;    ///< to bring every drive to Operation Enabled
  double homing_timeout_s = 120;  ///< for the drives of one turn
  StopCategories stop_categories{};
  int max_cycles_lost = 0;    ///< missed deadlines within a second; beyond it the machine stops; 0: not watched
  bool virtual_mode = false;  ///< setpoints are reflected as measured values; buses and I/O are not touched
  /// axes.size() positions where virtual mode begins when no loop hands over; empty: zeros.
  std::vector<double> virtual_start;
};

/// What the loop is to do in one cycle.
struct ServoCommand {
  Setpoint setpoint;   ///< of the kinematic joints; used when Engaged
  Frames frames;       ///< in force for `setpoint`
  bool power = false;  ///< after a fault or a quick stop it must fall before drives are enabled again
  bool quick_stop = false;
  bool home =
      false;  ///< its rise, when Engaged, has the drives home, turn by turn; its fall before they are through ends it
  bool reset = false;  ///< its rising edge resets the drives' faults, and leaves Faulted once they are gone
  std::array<double, kMaxSpindles> spindle_rpm{};
  double tool_torque_nm = 0;  ///< most that the tool in spindle 0 bears; 0: not given
  std::uint64_t outputs = 0;
  std::array<double, kMaxJoints> force{};  ///< wanted of joints under force control; 0: hold the position
  std::uint64_t cycles_missed = 0;         ///< deadlines that passed since the cycle before
};

/// What one cycle found and did. Arrays count joints (held ones included) or actuators; mm, deg, s, N, N·m.
struct ServoReport {
  ServoState state = ServoState::Off;
  bool follows = false;  ///< the command's setpoint was used; where not, hold the follower at `hold_position()`
  ServoFault fault;
  std::array<double, kMaxJoints> position_set{}, velocity_set{}, acceleration_set{};
  std::array<double, kMaxJoints> position{}, velocity{};
  std::array<double, kMaxJoints> effort{};  ///< at the joint, as commanded
  std::array<double, kMaxJoints> force{};   ///< as the joint's force sensor measures it; 0 where there is none
  std::array<ContactState, kMaxJoints> contact{};
  std::array<std::uint16_t, kMaxJoints> statusword{};
  std::array<std::uint16_t, kMaxJoints> error_code{};
  std::array<std::int16_t, kMaxJoints> torque_permille{};  ///< measured by the drives
  std::array<double, kMaxSpindles> spindle_rpm{};
  std::array<double, kMaxSpindles> spindle_torque_nm{};  ///< measured; 0 where the drive does not tell
  std::array<std::uint16_t, kMaxSpindles> spindle_statusword{};
  ToolPose pose;         ///< measured, part frame
  double feed_mm_s = 0;  ///< tool tip, from measured joints
  std::uint64_t inputs = 0;
  std::uint32_t homings = 0;     ///< that were completed
  std::int64_t exchange_ns = 0;  ///< of the cycle's time, that the exchange with buses and I/O took
  ProbeReport probe;
};

/// What a loop leaves to the one that comes after it, drive by drive, so that nothing jumps.
struct ServoHandover {
  struct Drive {
    const ServoBus* bus = nullptr;
    std::uint32_t axis = 0;
    std::int64_t counts = 0;     ///< unwrapped
    double setpoint_counts = 0;  ///< wanted position in encoder counts, before rounding
    double torque_nm = 0;        ///< commanded, in the drive's sense
    double backlash_side = 0;    ///< flank that carries, -1 to 1 in the drive's sense; 0 where several joints share it
    bool live = false;           ///< was under control
    bool seen = false;           ///< `counts` holds a reading
  };
  std::array<Drive, kMaxJoints> drives{};
  std::size_t count = 0;
};

/// One servo cycle of one mechanism, as a function. Built off the servo thread; then all members are the servo
/// thread's, and real-time safe: no allocation, lock or exception.
///
/// Order of a cycle: exchange with each bus (the words made in the cycle before go out, so a drive acts on a
/// measurement one cycle after it was taken); counts → shaft → joint; setpoint; servo law; effort → shaft → torque
/// word.
///
/// Joint velocity comes from the last three positions, (3 x0 - 4 x1 + x2) / (2 period): without lag as long as the
/// acceleration is steady, where a plain difference would be half a period late, which a D term pays for in phase. Its
/// noise is at most four encoder counts a period; a law may filter it further.
///
/// Joint positions are those of the joint, after pitch errors and backlash; efforts pass the joint's filters on their
/// way to the map.
///
/// After a cycle whose report says that it does not follow, the follower must be put at `hold_position()`
/// (`PlanFollower::hold_at`), so that engaging does not jump.
class ServoLoop {
 public:
  /// Checks that the parts fit together; the error says which do not. Off the servo thread.
  [[nodiscard]] static Expected<std::unique_ptr<ServoLoop>> create(ServoLoopParts parts);
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  [[nodiscard]] std::size_t joint_count() const noexcept;  ///< of the kinematics
  [[nodiscard]] std::size_t axis_count() const noexcept;   ///< held ones included
  [[nodiscard]] const ServoLoopParts& parts() const noexcept;

  /// Takes over from another loop between two cycles, before this one's first cycle. Drives that both have stay
  /// operational, with their setpoint and torque; drives of the same buses that this loop does not have go off.
  void engage(const ServoHandover& previous) noexcept;
  [[nodiscard]] ServoHandover handover() const noexcept;

  void cycle(const ServoCommand& command, ServoReport& report) noexcept;

  /// How far a joint under velocity control is off the plan, mm or degrees; 0 of other joints.
  [[nodiscard]] double slipped(std::size_t joint) const noexcept;
  /// What the joint's loop controls from the next cycle on, at rest or in motion: its position or its velocity. A joint
  /// that has not slipped goes on where it is, without a step.
  void set_control_method(std::size_t joint, ControlMethod method) noexcept;

  [[nodiscard]] ServoState state() const noexcept;
  /// Where the loop holds its axes: the last setpoint, or the measured position where there is no torque. axis_count()
  /// values, the kinematic joints first; zero before the first cycle unless `engage` was called.
  [[nodiscard]] std::span<const double> hold_position() const noexcept;

 private:
  struct Impl;
  explicit ServoLoop(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac
