#pragma once

#include <functional>
#include <optional>
#include <span>
#include <variant>

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/tools/tool_rack.hpp"
#include "rmac/sdk/rmac_cam.hpp"

namespace rmac::gateway {

/// RMAC_CAM (dissertation 4.5) on top of the motion supervisor: keeps what is in force for the next move, in the wire's
/// units, and bounds it by the mechanism. Gateway thread only.
class Cam final : public sdk::RmacCam, public ToolPort {
 public:
  /// `reset`: brings the machine back after a fault.
  Cam(MotionSupervisor& supervisor, ServoLink& link, ToolRack& rack, std::function<Expected<>()> reset);

  /// Takes the maxima of a mechanism. `fresh`: another one, so everything starts anew; otherwise what is in force stays
  /// as far as the new maxima let it.
  void mechanism_changed(const sdk::DeviceObject* device, bool fresh);

  Expected<> cycle_start(sdk::CycleMode mode) override;
  Expected<> cycle_stop() override;
  Expected<> feed_hold() override;
  Expected<> feed_resume() override;
  Expected<> stop_now() override;
  Expected<> reset() override;
  [[nodiscard]] bool cycle_start_status() const override;
  [[nodiscard]] bool cycle_stop_status() const override;
  Expected<> queue_move(std::int64_t id, const Geometry& geometry) override;
  [[nodiscard]] int moves_in_buffer() const override;
  [[nodiscard]] Expected<std::vector<double>> joints_at(const ToolPose& pose) const override;
  Expected<> set_feedrate(double mm_min) override;
  [[nodiscard]] double feedrate() const override;
  Expected<> set_max_feedrate(double mm_min) override;
  [[nodiscard]] double max_feedrate() const override;
  Expected<> set_feed_override(double percent) override;
  Expected<> set_path_accel_rise(double mm_s2) override;
  [[nodiscard]] double path_accel_rise() const override;
  Expected<> set_path_accel_fall(double mm_s2) override;
  [[nodiscard]] double path_accel_fall() const override;
  Expected<> set_joint_interp_speed(double percent) override;
  [[nodiscard]] double joint_interp_speed() const override;
  Expected<> set_joint_accel_rise(int joint, double value) override;
  [[nodiscard]] Expected<double> joint_accel_rise(int joint) const override;
  Expected<> set_joint_accel_fall(int joint, double value) override;
  [[nodiscard]] Expected<double> joint_accel_fall(int joint) const override;
  Expected<> set_path_tolerance(double mm) override;
  [[nodiscard]] double path_tolerance() const override;
  Expected<> set_part_frame(const Frame& frame) override;
  [[nodiscard]] Frame part_frame() const override;
  Expected<> set_tool_interface_frame(const Frame& frame) override;
  [[nodiscard]] Frame tool_interface_frame() const override;
  Expected<> set_spindle_rpm(int spindle, double rpm) override;
  [[nodiscard]] Expected<double> spindle_rpm(int spindle) const override;
  Expected<> set_spindle_max_rpm(int spindle, double rpm) override;
  [[nodiscard]] Expected<double> spindle_max_rpm(int spindle) const override;
  Expected<> set_coolant(bool on) override;
  Expected<> set_joint_force(int joint, double force) override;
  Expected<double> feed_retrace(double distance_mm) override;
  Expected<> jog_joint(int joint, double distance) override;
  Expected<> jog_joint_at(int joint, double velocity) override;
  Expected<> jog_path(const sdk::JogDirection& direction, double distance_mm) override;
  Expected<> jog_path_at(const sdk::JogDirection& direction, double velocity_mm_s) override;
  Expected<> home() override;
  Expected<> move_to_reference_point() override;
  [[nodiscard]] Expected<std::vector<double>> current_position() const override;
  Expected<> set_animation(bool on) override;
  Expected<> park_program() override;
  Expected<> take_up_program() override;
  Expected<> drop_parked_program() override;
  [[nodiscard]] std::optional<sdk::ParkedProgram> parked_program() const override;

  [[nodiscard]] Expected<std::vector<Tool>> tools() const override;
  [[nodiscard]] ToolsNow tools_now() const override { return supervisor_.tools_now(); }
  Expected<> set_tool(const Tool& tool) override;
  Expected<> remove_tool(int number) override;
  Expected<> change_tool(int number) override;
  Expected<> confirm_tool(int number) override;
  /// Writes down what is in the spindle now.
  [[nodiscard]] Expected<> keep_mounted();
  /// What the measuring part of RMAC_CAM is made of.
  [[nodiscard]] Expected<> require_mechanism(const char* function) const;
  /// A path move at a speed of its own, in mm/s, bounded as feeds are.
  [[nodiscard]] Expected<Move> path_move_at(const char* function, std::int64_t id, const Geometry& geometry,
                                            double speed_mm_s) const;
  /// Queues a move of all joints together, at a speed of the linear ones together, or of all where none moves.
  [[nodiscard]] Expected<> queue_joints_at(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                           double speed);
  [[nodiscard]] Expected<std::size_t> find_joint(int joint, const char* function) const;
  [[nodiscard]] Expected<std::size_t> find_spindle(int spindle, const char* function) const;
  /// Where the tool is meant to be now, in the part frame; and in the machine frame.
  [[nodiscard]] ToolPose tool_pose_set() const;
  [[nodiscard]] ToolPose tool_pose_in_machine() const;
  /// Of these joints, in the part frame.
  [[nodiscard]] ToolPose tool_pose_at(std::span<const double> joints) const;

 private:
  static constexpr double kSecondsPerMinute = 60;
  static constexpr const char* kCoolantOutput = "Coolant";

  [[nodiscard]] Expected<> check_accel(const char* function, double mm_s2, double bound_mm_s2) const;
  [[nodiscard]] Expected<> set_frames(const char* function, const Frames& frames);
  [[nodiscard]] Frames frames() const { return supervisor_.wishes().frames; }
  [[nodiscard]] Expected<Tool> find_tool(int number, const char* function) const;
  /// Refuses a move that the tool in the spindle, or the one that is to be there, cannot make.
  [[nodiscard]] Expected<> check_tool(std::int64_t move_id, bool feeds) const;
  [[nodiscard]] Expected<> check_tool_speed(double rpm) const;
  /// Refuses a change that is to be automatic and cannot be.
  [[nodiscard]] Expected<> check_changer(const ToolsNow& now) const;
  [[nodiscard]] BeginToolChange begin_change() const;
  [[nodiscard]] std::vector<QueueStep> change_by_hand(const Tool& tool) const;
  /// As `ToolChange` of device.json says; leaves the builder where the steps leave the machine.
  [[nodiscard]] Expected<std::vector<QueueStep>> change_by_changer(int old, const Tool& tool);
  [[nodiscard]] Expected<QueueStep> changer_step(const sdk::ToolChangeStep& step, int number);
  [[nodiscard]] Expected<> set_joint_accel(std::vector<double>& accel, const char* function, int joint, double value);
  /// Joints under force control hold their positions.
  void let_go_of_forces();
  /// A positioning move of all joints together, as it is made from `from`.
  [[nodiscard]] Move make_joint_move(std::int64_t id, const JointTargetGeometry& target,
                                     std::span<const double> from) const;
  [[nodiscard]] Move make_move(std::int64_t id, const Geometry& geometry) const;
  /// A straight positioning move of the tool tip from where it stands.
  [[nodiscard]] Move make_straight_move(const ToolPose& target) const;

  /// What a jog by velocity moves, and at what speed when it is not slowed down.
  struct Jog {
    std::variant<int, sdk::JogDirection> what;
    bool positive = true;
    double fastest = 0;
  };
  /// Goes on with the jog under way if it is this one, or starts it with the move that `begin` makes.
  Expected<> jog_at(const char* function, const Jog& jog, double velocity,
                    const std::function<Expected<Move>()>& begin);
  [[nodiscard]] Expected<Vector> part_direction(const char* function, const sdk::JogDirection& direction) const;
  /// Refuses a jog towards a limit switch that is on.
  [[nodiscard]] Expected<> check_limit_switches(std::size_t joint, bool positive) const;
  /// How far the tip can go straight from where it stands before a joint leaves its travel or the reach ends.
  [[nodiscard]] Expected<double> straight_reach(const Vector& direction) const;

  MotionSupervisor& supervisor_;
  ServoLink& link_;
  ToolRack& rack_;
  std::function<Expected<>()> reset_;

  const sdk::DeviceObject* device_ = nullptr;
  /// What is in force for the next move.
  struct Settings {
    double feedrate_mm_min = 0;
    double max_feedrate_mm_min = 0;
    double accel_rise_mm_s2 = 0;
    double accel_fall_mm_s2 = 0;
    double joint_interp_percent = 100;
    double tolerance_mm = 0;
    std::vector<double> spindle_max_rpm;
    std::vector<double> joint_accel_rise;
    std::vector<double> joint_accel_fall;
  };
  Settings settings_;
  Settings parked_settings_;  ///< of the program that is parked, if there is one
  std::optional<Jog> jog_;    ///< by velocity, begun last
};

}  // namespace rmac::gateway
