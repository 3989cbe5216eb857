#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/force_control.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/motion/joint_mechanics.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"
#include "rmac/motion/servo/cogging.hpp"
#include "rmac/motion/servo/gantry.hpp"
#include "rmac/sdk/config/module_choice.hpp"

namespace rmac::sdk {

/// Where a joint's force sensor is read: a word beside those of a drive.
struct ForceSensor {
  std::string bus;
  std::uint32_t axis = 0;
  double newton_per_count = 0;
  std::int32_t zero_counts = 0;
};

/// One joint: its limits, its loop, and the drive behind it.
struct Joint {
  JointLimits limits;
  ModuleChoice servo_law;  ///< no name: the joint's drives close its loop themselves
  ControlMethod method = ControlMethod::Position;
  std::vector<double> gains;
  double max_following_error = 0;  ///< mm or degrees; beyond it the machine stops
  double max_effort = 0;           ///< N or N·m at the joint
  JointMechanics mechanics{};
  double max_measured_speed = 0;  ///< mm/s or deg/s; beyond it the machine stops; 0: a fifth above `max_speed`
  double max_jump = 0;            ///< mm or deg of encoder jump; 0: what three cycles at `max_speed` go
  std::optional<ForceSensor> force_sensor{};
  std::optional<ForceControl> force{};
  std::optional<Gantry> gantry{};  ///< none: of motors side by side a skew of `max_following_error` is allowed
};

/// One actuator: which axis of which bus, and its scale.
struct Actuator {
  std::string bus;
  std::uint32_t axis = 0;
  DriveScale scale;
  int homing_turn = 0;                         ///< in which its drive looks for home by itself, from 1; 0: it does not
  double max_measured_torque_nm = 0;           ///< beyond it the machine stops; 0: 3.5 times the rated one
  double position_gain = 0;                    ///< 1/s: of the loop over a drive in cyclic synchronous velocity
  std::optional<TouchProbeEdge> probe_edge{};  ///< at which the drive latches its position for a hit of the probe
  Cogging cogging{};                           ///< of the motor
};

/// An input of a drive (60FDh) among the machine's inputs.
struct DriveInput {
  std::size_t actuator = 0;
  int bit = 0;  ///< of the drive's
};

struct Spindle {
  std::string bus;
  std::uint32_t axis = 0;
  double max_speed_rpm = 0;
  double max_torque_nm = 0;
  double horse_power = 0;
  double speed_tolerance_rpm = 0;  ///< how near counts as at speed
  double speed_timeout_s = 0;
  ModuleChoice servo_law{};  ///< no name: its drive closes its speed loop itself
  ControlMethod method = ControlMethod::Velocity;
  std::vector<double> gains{};
  DriveScale scale{};                 ///< of a drive that takes a torque; the rated torque of one that tells its torque
  double max_acceleration_rpm_s = 0;  ///< of the speed that a drive in a cyclic mode is told
  double max_following_error_deg = 0;  ///< under `ControlMethod::Position`
};

/// One step of what a tool changer does, in order.
struct ToolChangeStep {
  enum class Kind : std::uint8_t {
    MoveTo,  ///< all joints, together
    Switch,  ///< outputs on or off
    Select,  ///< the outputs' bits tell the changer the tool's number, the first output the lowest
    Await,   ///< until an input is on or off; a fault when that takes too long
  };
  enum class Whose : std::uint8_t { Both, Old, New };
  Kind kind = Kind::Switch;
  Whose whose = Whose::Both;  ///< taken only where there is such a tool, and not an empty spindle
  std::vector<double> joints;
  std::vector<std::string> outputs;
  std::string input;
  bool on = true;
  double timeout_s = 0;
};

/// How a touch probe measures (Appendix IV's parameters, as they begin).
struct Probing {
  double prehit_distance_mm = 3;  ///< before the point that is measured the approach ends, and the search begins
  double search_distance_mm = 5;  ///< beyond it the search ends
  double retract_distance_mm = 3;
  double scan_speed_mm_s = 5;    ///< of the search
  double settle_time_s = 0.005;  ///< a contact that opens for less bounces
};

/// The dissertation's device object (figure 4.8): everything about one mechanism, as typed values. The gateway fills it
/// from `device.json`.
struct DeviceObject {
  std::string name;
  std::string device_driver;
  std::string driver_version;      ///< "1.2.3"
  std::string type;                ///< "Mill", "CMM", "Robot"
  std::string configuration_type;  ///< "3-axis"
  std::string speed_capability;
  bool tool_changer = false;
  int number_of_tools = 1;
  double length_mm = 0, width_mm = 0, depth_mm = 0;  ///< working volume
  double max_feedrate_mm_min = 0;
  double max_pallet_load_kg = 0;
  double positioning_tolerance_mm = 0, repeatability_tolerance_mm = 0;
  double path_accel_rise_mm_s2 = 0, path_accel_fall_mm_s2 = 0;  ///< 0: bounded by the joints alone
  std::vector<Joint> joints;
  std::vector<Joint> held_joints;   ///< driven, but not moved by this mechanism: they keep the position they have
  std::vector<Actuator> actuators;  ///< behind joints, then behind held joints, as the actuator map orders them
  std::vector<Spindle> spindles;
  bool overlay = false;    ///< a role of whatever mechanism is loaded
  std::string overlay_of;  ///< the mechanism that it lies over; empty: none
  Probing probing;
  ModuleChoice kinematics;
  ModuleChoice actuator_map;
  ModuleChoice digital_control_interface;
  ModuleChoice digital_io_interface;
  std::map<std::string, int> inputs, outputs;  ///< names of I/O bits, e.g. outputs["Coolant"]
  std::map<int, DriveInput> drive_inputs;   ///< bits of `inputs` that drives tell; the I/O interface tells the others
  std::vector<ToolChangeStep> tool_change;  ///< of a tool changer; the spindles stand by then

  [[nodiscard]] std::size_t joint_count_with_held() const noexcept { return joints.size() + held_joints.size(); }

  /// The mechanism whose joints, drives and tools these are.
  [[nodiscard]] const std::string& machine() const noexcept { return overlay_of.empty() ? name : overlay_of; }
};

/// A joint of a device object by its number: joints count first, held joints follow. `number` is below
/// `joint_count_with_held`.
[[nodiscard]] auto& joint_at(auto& device, std::size_t number) {
  const std::size_t moved = device.joints.size();
  return number < moved ? device.joints[number] : device.held_joints[number - moved];
}

}  // namespace rmac::sdk
