#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/force_control.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/motion/joint_mechanics.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/motion/servo/cogging.hpp"
#include "rmac/motion/servo/gantry.hpp"
#include "rmac/motion/servo/servo_bus.hpp"
#include "rmac/motion/servo/servo_fault.hpp"
#include "rmac/motion/servo/servo_inputs.hpp"
#include "rmac/motion/servo/servo_spindle.hpp"

namespace rmac {

/// Where a joint's force sensor is read: a word beside those of a drive, of this mechanism or not.
struct ServoForceSensor {
  std::shared_ptr<ServoBus> bus;
  std::uint32_t axis = 0;  ///< of the bus
  double newton_per_count = 0;
  std::int32_t zero_counts = 0;  ///< reading without force
};

/// What a joint's measured motion is held to, in mm and s, or degrees and s; 0: not watched.
struct JointBounds {
  double velocity = 0;           ///< beyond it for three cycles on end the machine stops
  double jump = 0;               ///< change of a position's step from cycle to cycle that no motion explains
  double stop_deceleration = 0;  ///< of a stop that keeps power; 0: the setpoint stands at once
  double stop_jerk = 0;          ///< the same
  double min_position = -std::numeric_limits<double>::infinity();  ///< travel, where no plan keeps the joint in it
  double max_position = std::numeric_limits<double>::infinity();
};

/// The loop of one joint.
struct ServoJoint {
  /// Gains set; the loop sets the effort limit. Null where the joint's drives close its loop themselves; or, where they
  /// take a torque beside, what that torque is: the law is told then that the joint is where it is to be.
  std::shared_ptr<ServoLaw> law;
  ControlMethod method = ControlMethod::Position;
  double max_following_error = 0;  ///< mm or deg
  double max_effort = 0;           ///< N or N·m at the joint
  JointMechanics mechanics{};      ///< made good between the law and the drive
  JointBounds bounds{};
  std::optional<ServoForceSensor> force_sensor{};
  ForceControl force{};            ///< used under `ControlMethod::Force`
  std::optional<Gantry> gantry{};  ///< none: of motors side by side a skew of `max_following_error` is allowed
};

/// A motor that moves joints: its drive in torque mode, behind the law of its joint, or following the joint's setpoint
/// itself.
struct ServoActuator {
  std::shared_ptr<ServoBus> bus;
  std::uint32_t axis = 0;  ///< of the bus: the place of its drive there
  DriveScale scale;
  std::uint8_t homing_turn = 0;  ///< in which its drive looks for home by itself, from 1; 0: it does not
  double max_torque_nm = 0;      ///< measured by the drive; beyond it for three cycles on end the machine stops; 0: not
                                 ///< watched
  /// Cyclic synchronous torque, velocity or position.
  DriveMode mode = DriveMode::CyclicSyncTorque;
  double position_gain = 0;  ///< 1/s: of the position loop that is closed here over a drive in velocity mode
  std::optional<TouchProbeEdge> probe_edge{};  ///< at which its drive latches the position of a hit
  Cogging cogging{};                           ///< of the motor, made good in its torque
};

/// What a servo loop is made of. `joints`: the kinematic ones, then the held ones; `actuators` in the order of the map.
struct ServoLoopParts {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const ActuatorMap> actuator_map;
  std::vector<ServoJoint> joints;
  std::vector<ServoActuator> actuators;
  std::vector<ServoSpindle> spindles;
  std::shared_ptr<DigitalIoInterface> io;  ///< may be null
  /// Inputs that stop all drives while any is on; a reset has to wait until they are off.
  std::uint64_t emergency_stop_inputs = 0;
  /// Inputs that stop all drives as they come on. A reset helps while they are on, so that the joint can be moved off.
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
  /// joints.size() positions where virtual mode begins when no loop hands over; empty: zeros.
  std::vector<double> virtual_start;
};

}  // namespace rmac
