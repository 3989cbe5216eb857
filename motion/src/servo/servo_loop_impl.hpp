#pragma once

#include <vector>

#include "rmac/motion/drive_power.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_handover.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "servo/drives/exchange.hpp"
#include "servo/drives/shaft_aims.hpp"
#include "servo/drives/shaft_torques.hpp"
#include "servo/drives/shafts.hpp"
#include "servo/gantry/gantries.hpp"
#include "servo/homing/homing.hpp"
#include "servo/joints/joint_reader.hpp"
#include "servo/joints/live_joints.hpp"
#include "servo/joints/transmission.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/laws/joint_laws.hpp"
#include "servo/probe/probe.hpp"
#include "servo/setpoint/setpoints.hpp"
#include "servo/spindles/spindles.hpp"
#include "servo/state/loop_state.hpp"
#include "servo/stop/rest_watch.hpp"
#include "servo/watch/input_watch.hpp"
#include "servo/watch/motion_watch.hpp"
#include "servo/watch/position_watch.hpp"

namespace rmac {

/// The objects that a servo loop is made of, and the way of one cycle through them: exchange, read, watch, state,
/// setpoint, laws, write. What is found wrong goes to `state`, which decides; `settle` has the others do it.
struct ServoLoop::Impl {
  explicit Impl(ServoLoopParts loop_parts);

  void cycle(const ServoCommand& command, ServoReport& report) noexcept;
  void take_over(const ServoHandover& previous) noexcept;
  [[nodiscard]] ServoHandover handover() const noexcept;

  // The steps of a cycle, in their order.
  void receive(const ServoCommand& command) noexcept;
  void obey(const ServoCommand& command) noexcept;
  /// `missed`: cycles that were left out before this one.
  void read(std::uint64_t missed) noexcept;
  void watch_drives(const ServoCommand& command) noexcept;
  void finish_reset() noexcept;
  void run_homing(const ServoCommand& command) noexcept;
  void go_live() noexcept;
  void choose_setpoints(const ServoCommand& command) noexcept;
  void watch_motion(const ServoCommand& command) noexcept;
  void run_laws() noexcept;
  void watch_power() noexcept;
  void make_setpoints_of_drives() noexcept;
  void write() noexcept;
  void fill(const ServoCommand& command, ServoReport& report) const noexcept;

  /// Joints and drives follow what `state` has become: after each step in which something may be found wrong.
  void settle() noexcept;
  void move_without_drives(const ServoCommand& command) noexcept;
  void take_over_joints(IndexSet live_drives, std::span<const double> shaft_set) noexcept;

  [[nodiscard]] const DriveFeedback& told(std::size_t actuator) const noexcept;
  [[nodiscard]] bool operable(std::size_t joint) const noexcept;
  [[nodiscard]] IndexSet controlled() const noexcept;
  [[nodiscard]] ServoInput input(std::size_t joint) const noexcept;
  void engage_law(std::size_t joint, double from_effort) noexcept;
  [[nodiscard]] JointSeen seen(std::size_t joint) const noexcept;
  [[nodiscard]] DriveWish wish(ServoFault::Part part, std::size_t index) const noexcept;
  [[nodiscard]] bool stands() const noexcept;

  ServoLoopParts parts;
  Wiring wiring;
  LoopState state;
  Exchange exchange;
  InputWatch inputs;
  Probe probe;
  Shafts shafts;
  PositionWatch positions;
  Transmission transmission;
  JointReader joints;
  Gantries gantries;
  LiveJoints live;
  Homing homing;
  Setpoints setpoints;
  MotionWatch motion_watch;
  JointLaws laws;
  Spindles spindles;
  RestWatch rest;
  ShaftTorques torques;
  ShaftAims aims;
};

}  // namespace rmac
