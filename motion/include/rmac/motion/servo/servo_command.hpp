#pragma once

#include <array>
#include <cstdint>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/pose.hpp"
#include "rmac/motion/servo/setpoint.hpp"

namespace rmac {

/// What the loop is to do in one cycle.
struct ServoCommand {
  Setpoint setpoint;     ///< of the kinematic joints; used when Engaged
  Frames frames;         ///< in force for `setpoint`
  bool program = false;  ///< `setpoint` goes forward on a program's path: what was learned of it counts
  bool power = false;    ///< after a fault or a quick stop it must fall before drives are enabled again
  bool quick_stop = false;
  /// Its rise, when Engaged, has the drives home, turn by turn; its fall before they are through ends it.
  bool home = false;
  bool reset = false;  ///< its rising edge resets the drives' faults, and leaves Faulted once they are gone
  std::array<double, kMaxSpindles> spindle_rpm{};
  double tool_torque_nm = 0;  ///< most that the tool in spindle 0 bears; 0: not given
  std::uint64_t outputs = 0;
  std::array<double, kMaxJoints> force{};  ///< wanted of joints under force control; 0: hold the position
  std::uint64_t cycles_missed = 0;         ///< deadlines that passed since the cycle before
};

}  // namespace rmac
