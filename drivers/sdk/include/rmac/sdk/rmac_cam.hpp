#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::sdk {

enum class CycleMode { Manual = 0, Automatic = 1 };

/// The RMAC_CAM interface (dissertation 4.5, Appendix IV): motion and control commands, and the machine's answers.
/// Units are the wire's: mm, deg, mm/min, rpm. Gateway thread only. Functions whose machinery does not exist yet are
/// not here; the API table says so.
/// A direction of jogging, of any length but zero: in the part frame, or in the tool's. The tool's frame has the tool
/// axis for its Z, and is the part frame turned by the smallest rotation that brings Z there.
struct JogDirection {
  Vector vector{};
  bool in_tool_frame = false;

  bool operator==(const JogDirection&) const = default;
};

/// A program that was set aside in the midst of it.
struct ParkedProgram {
  std::string mechanism;
  std::size_t moves = 0;     ///< and tool changes to do, the move that was begun included
  std::int64_t move_id = 0;  ///< of that one
  double s_mm = 0;           ///< how far along it the tool was
  ToolPose place;            ///< where it goes on, in the part frame that is in force
  double off_mm = 0;         ///< how far the tool stands from there
};

class RmacCam {
 public:
  virtual ~RmacCam() = default;

  virtual Expected<> cycle_start(CycleMode mode) = 0;
  virtual Expected<> cycle_stop() = 0;
  virtual Expected<> feed_hold() = 0;
  virtual Expected<> feed_resume() = 0;
  /// Stops as fast as the limits allow and empties the queue.
  virtual Expected<> stop_now() = 0;
  /// Leaves `Faulted` or `EmergencyStop` once the cause is gone.
  virtual Expected<> reset() = 0;
  [[nodiscard]] virtual bool cycle_start_status() const = 0;
  [[nodiscard]] virtual bool cycle_stop_status() const = 0;

  /// Checks and queues a move; `geometry` is in the part frame. A full queue is CommandQueueFull: the caller waits and
  /// asks again.
  virtual Expected<> queue_move(std::int64_t id, const Geometry& geometry) = 0;
  [[nodiscard]] virtual int moves_in_buffer() const = 0;
  /// Joints that put the tool at `pose` (part frame); of several solutions the one nearest to the end of the queue.
  [[nodiscard]] virtual Expected<std::vector<double>> joints_at(const ToolPose& /*pose*/) const {
    return failure(MinorCode::UnsupportedOperation,
                   "a joint target given as a pose is not supported yet; give {\"joints\": [...]}");
  }

  virtual Expected<> set_feedrate(double mm_min) = 0;
  /// Actual speed of the tool tip from measured joints, mm/min.
  [[nodiscard]] virtual double feedrate() const = 0;
  virtual Expected<> set_max_feedrate(double mm_min) = 0;
  [[nodiscard]] virtual double max_feedrate() const = 0;
  virtual Expected<> set_feed_override(double percent) = 0;
  virtual Expected<> set_path_accel_rise(double mm_s2) = 0;
  [[nodiscard]] virtual double path_accel_rise() const = 0;
  virtual Expected<> set_path_accel_fall(double mm_s2) = 0;
  [[nodiscard]] virtual double path_accel_fall() const = 0;
  virtual Expected<> set_joint_interp_speed(double percent) = 0;
  [[nodiscard]] virtual double joint_interp_speed() const = 0;
  /// Acceleration of one joint in joint moves, jogs and `home` while its speed rises; at most the joint's limit.
  virtual Expected<> set_joint_accel_rise(int joint, double value) = 0;
  [[nodiscard]] virtual Expected<double> joint_accel_rise(int joint) const = 0;
  /// Likewise while its speed falls.
  virtual Expected<> set_joint_accel_fall(int joint, double value) = 0;
  [[nodiscard]] virtual Expected<double> joint_accel_fall(int joint) const = 0;
  virtual Expected<> set_path_tolerance(double mm) = 0;
  [[nodiscard]] virtual double path_tolerance() const = 0;
  virtual Expected<> set_part_frame(const Frame& frame) = 0;
  [[nodiscard]] virtual Frame part_frame() const = 0;
  virtual Expected<> set_tool_interface_frame(const Frame& frame) = 0;
  [[nodiscard]] virtual Frame tool_interface_frame() const = 0;

  virtual Expected<> set_spindle_rpm(int spindle, double rpm) = 0;
  /// Measured.
  [[nodiscard]] virtual Expected<double> spindle_rpm(int spindle) const = 0;
  virtual Expected<> set_spindle_max_rpm(int spindle, double rpm) = 0;
  [[nodiscard]] virtual Expected<double> spindle_max_rpm(int spindle) const = 0;
  virtual Expected<> set_coolant(bool on) = 0;

  /// Contact force that a joint under force control keeps, N or N·m, positive towards larger positions; 0: it holds its
  /// position. The joint goes for contact by itself.
  virtual Expected<> set_joint_force(int joint, double force) = 0;

  /// Runs back along up to `distance_mm` of the path of what is held, then holds again; `feed_resume` runs forward from
  /// there, at any time. The way it will go, in mm.
  virtual Expected<double> feed_retrace(double distance_mm) = 0;

  /// Moves one joint by a distance, from rest, at the joint interpolation speed.
  virtual Expected<> jog_joint(int joint, double distance) = 0;
  /// Moves one joint at a velocity, from rest, up to its limit at most, for 200 ms; called again within that time, with
  /// the velocity that is wanted now, it goes on.
  virtual Expected<> jog_joint_at(int joint, double velocity) = 0;
  /// Moves the tool tip straight by a distance, from rest, at the feed in force; the tool axis stays as it is.
  virtual Expected<> jog_path(const JogDirection& direction, double distance_mm) = 0;
  /// Likewise at a velocity in mm/s, as `jog_joint_at`, as far as every joint can go.
  virtual Expected<> jog_path_at(const JogDirection& direction, double velocity_mm_s) = 0;
  /// Moves all joints to their home position (zero), from rest.
  virtual Expected<> home() = 0;
  /// Moves the tool tip straight to the zero of the part frame, from rest; the tool axis stays as it is.
  virtual Expected<> move_to_reference_point() = 0;
  /// Measured joint positions.
  [[nodiscard]] virtual Expected<std::vector<double>> current_position() const = 0;
  virtual Expected<> set_animation(bool on) = 0;

  /// Sets what is held aside, from its place on: the queue is empty then, and the machine free to be jogged, measured
  /// with, or loaded in another role. Spindle and coolant go off.
  virtual Expected<> park_program() = 0;
  /// Queues it again, in the part frame and with the tool in force now, and holds it: `feed_resume` switches spindle
  /// and coolant on again and goes on. The tool must stand within a millimetre of the place; the last bit is made
  /// straight. On a refusal the program stays parked.
  virtual Expected<> take_up_program() = 0;
  virtual Expected<> drop_parked_program() = 0;
  [[nodiscard]] virtual std::optional<ParkedProgram> parked_program() const = 0;
};

}  // namespace rmac::sdk
