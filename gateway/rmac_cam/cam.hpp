#pragma once

#include <functional>
#include <span>

#include "gateway/controller/motion_supervisor.hpp"
#include "rmac/sdk/rmac_cam.hpp"

namespace rmac::gateway {

/// RMAC_CAM (dissertation 4.5) on top of the motion supervisor: keeps what is in force for the next move, in the wire's
/// units, and bounds it by the mechanism. Gateway thread only.
class Cam final : public sdk::RmacCam {
 public:
  /// `reset`: brings the machine back after a fault.
  Cam(MotionSupervisor& supervisor, ServoLink& link, std::function<Expected<>()> reset);

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
  Expected<> jog_joint(int joint, double distance) override;
  Expected<> home() override;
  Expected<> move_to_reference_point() override;
  [[nodiscard]] Expected<std::vector<double>> current_position() const override;
  Expected<> set_animation(bool on) override;

 private:
  [[nodiscard]] Expected<> require_mechanism(const char* function) const;
  [[nodiscard]] Expected<std::size_t> find_spindle(int spindle, const char* function) const;
  [[nodiscard]] Expected<> check_accel(const char* function, double mm_s2, double bound_mm_s2) const;
  [[nodiscard]] Expected<> set_frames(const char* function, const Frames& frames);
  [[nodiscard]] Expected<std::size_t> find_joint(int joint, const char* function) const;
  [[nodiscard]] Expected<> set_joint_accel(std::vector<double>& accel, const char* function, int joint, double value);
  /// A positioning move of all joints together, as it is made from `from`.
  [[nodiscard]] Move make_joint_move(std::int64_t id, const JointTargetGeometry& target,
                                     std::span<const double> from) const;
  [[nodiscard]] Move make_move(std::int64_t id, const Geometry& geometry) const;

  MotionSupervisor& supervisor_;
  ServoLink& link_;
  std::function<Expected<>()> reset_;

  const sdk::DeviceObject* device_ = nullptr;
  double feedrate_mm_min_ = 0;
  double max_feedrate_mm_min_ = 0;
  double accel_rise_mm_s2_ = 0;
  double accel_fall_mm_s2_ = 0;
  double joint_interp_percent_ = 100;
  double tolerance_mm_ = 0;
  Frames frames_;
  std::vector<double> spindle_max_rpm_;
  std::vector<double> joint_accel_rise_;
  std::vector<double> joint_accel_fall_;
};

}  // namespace rmac::gateway
