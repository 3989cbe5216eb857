#include "gateway/rmac_cam/cam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/frame_check.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

}  // namespace

Cam::Cam(MotionSupervisor& supervisor, ServoLink& link, ToolRack& rack, std::function<Expected<>()> reset)
    : supervisor_(supervisor), link_(link), rack_(rack), reset_(std::move(reset)) {}

void Cam::mechanism_changed(const sdk::DeviceObject* device, bool fresh) {
  device_ = device;
  const sdk::DeviceObject none;
  const sdk::DeviceObject& now = device != nullptr ? *device : none;
  if (fresh) {
    settings_.feedrate_mm_min = 0;
    settings_.max_feedrate_mm_min = now.max_feedrate_mm_min;
    settings_.accel_rise_mm_s2 = now.path_accel_rise_mm_s2;
    settings_.accel_fall_mm_s2 = now.path_accel_fall_mm_s2;
    settings_.joint_interp_percent = 100;
    settings_.tolerance_mm = 0;
    settings_.spindle_max_rpm.clear();
    supervisor_.set_override(100);
    // The tool stays in the spindle whoever was loaded meanwhile.
    const auto mounted = device != nullptr ? rack_.mounted() : kNoTool;
    const auto tool = mounted && *mounted != kNoTool ? rack_.tool(*mounted) : std::nullopt;
    supervisor_.set_mounted(mounted, tool ? tool->max_torque_nm : 0);
    if (tool) supervisor_.set_frames({{}, tip_on_interface(*tool)});
  }
  let_go_of_forces();
  // A configuration defines the mechanism: its maxima are the new bounds of ours, upwards too.
  settings_.max_feedrate_mm_min = now.max_feedrate_mm_min;
  settings_.spindle_max_rpm.clear();
  settings_.joint_accel_rise.clear();
  for (const sdk::Joint& joint : now.joints) settings_.joint_accel_rise.push_back(joint.limits.max_acceleration);
  settings_.joint_accel_fall = settings_.joint_accel_rise;
  for (const sdk::Spindle& spindle : now.spindles) settings_.spindle_max_rpm.push_back(spindle.max_speed_rpm);
}

Expected<> Cam::require_mechanism(const char* function) const {
  if (device_ != nullptr) return {};
  return failure(MinorCode::Other, fmt::format("{}: no mechanism is loaded; load one with Device.Load", function));
}

Expected<> Cam::cycle_start(sdk::CycleMode mode) {
  return require_mechanism("CycleStart").and_then([&] {
    return supervisor_.command(
        [mode](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.start(mode, seen); });
  });
}

Expected<> Cam::cycle_stop() {
  let_go_of_forces();
  return supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.stop(); });
}

Expected<> Cam::feed_hold() {
  return supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.hold(); });
}

Expected<> Cam::feed_resume() {
  return supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.resume(); });
}

Expected<double> Cam::feed_retrace(double distance_mm) {
  return require_mechanism("FeedRetrace").and_then([&] { return supervisor_.retrace(distance_mm); });
}

Expected<> Cam::stop_now() {
  let_go_of_forces();
  return supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.stop_and_clear(); });
}

Expected<> Cam::reset() {
  return reset_();
}

bool Cam::cycle_start_status() const {
  const CycleState state = supervisor_.state();
  return state == CycleState::Running || state == CycleState::Holding;
}

bool Cam::cycle_stop_status() const {
  return !cycle_start_status();
}

Move Cam::make_move(std::int64_t id, const Geometry& geometry) const {
  return {.id = id,
          .geometry = geometry,
          .feed_mm_s = settings_.feedrate_mm_min / kSecondsPerMinute,
          .tolerance_mm = settings_.tolerance_mm,
          .accel_rise_mm_s2 = settings_.accel_rise_mm_s2,
          .accel_fall_mm_s2 = settings_.accel_fall_mm_s2,
          .joint_speed_fraction = settings_.joint_interp_percent / 100};
}

Expected<> Cam::queue_move(std::int64_t id, const Geometry& geometry) {
  if (auto loaded = require_mechanism("move"); !loaded) return loaded;
  const bool in_joints = in_joint_space(geometry);
  if (!in_joints && !(settings_.feedrate_mm_min > 0)) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("move {}: no feed is set; use SetFeedrate before the first move", id));
  }
  // The maximum may have been lowered since the feed was set.
  if (!in_joints && settings_.feedrate_mm_min > settings_.max_feedrate_mm_min) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("move {}: the feed in force, {} mm/min, is above the maximum of {} mm/min; set a lower "
                               "one with SetFeedrate",
                               id, settings_.feedrate_mm_min, settings_.max_feedrate_mm_min));
  }
  if (auto fits = check_tool(id, !in_joints && !std::holds_alternative<PathTargetGeometry>(geometry)); !fits) {
    return fits;
  }
  return supervisor_.prepare_move()
      .and_then([&] {
        const auto* target = std::get_if<JointTargetGeometry>(&geometry);
        if (target == nullptr) return supervisor_.add_move(make_move(id, geometry));
        return supervisor_.add_move(make_joint_move(id, *target, supervisor_.mechanism()->builder.end_joints()));
      })
      .map([](bool) {});
}

int Cam::moves_in_buffer() const {
  return static_cast<int>(supervisor_.moves_left());
}

Expected<> Cam::set_feedrate(double mm_min) {
  if (auto loaded = require_mechanism("SetFeedrate"); !loaded) return loaded;
  if (!positive(mm_min)) return refuse(fmt::format("SetFeedrate: {} mm/min must be above 0", mm_min));
  if (mm_min > settings_.max_feedrate_mm_min) {
    return failure(MinorCode::SpeedLimit, fmt::format("SetFeedrate: {} mm/min is above the maximum of {} mm/min",
                                                      mm_min, settings_.max_feedrate_mm_min));
  }
  settings_.feedrate_mm_min = mm_min;
  return {};
}

double Cam::feedrate() const {
  return link_.history.latest().feed_actual_mm_s * kSecondsPerMinute;
}

Expected<> Cam::set_max_feedrate(double mm_min) {
  if (auto loaded = require_mechanism("SetMaxFeedrate"); !loaded) return loaded;
  if (!positive(mm_min)) return refuse(fmt::format("SetMaxFeedrate: {} mm/min must be above 0", mm_min));
  if (mm_min > device_->max_feedrate_mm_min) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetMaxFeedrate: {} mm/min is above the mechanism's {} mm/min, which RMAC_CAM can only "
                               "tighten",
                               mm_min, device_->max_feedrate_mm_min));
  }
  settings_.max_feedrate_mm_min = mm_min;
  return {};
}

double Cam::max_feedrate() const {
  return settings_.max_feedrate_mm_min;
}

Expected<> Cam::set_feed_override(double percent) {
  constexpr double kSlowestPercent = 0.01;
  const bool waits = percent == 0;
  if (!waits && !(percent >= kSlowestPercent && percent <= 200)) {
    return refuse(
        fmt::format("SetFeedOverride: {} percent must be 0, which waits, or {} to 200", percent, kSlowestPercent));
  }
  supervisor_.set_override(percent);
  return {};
}

Expected<> Cam::check_accel(const char* function, double mm_s2, double bound_mm_s2) const {
  if (auto loaded = require_mechanism(function); !loaded) return loaded;
  if (!positive(mm_s2)) return refuse(fmt::format("{}: {} mm/s² must be above 0", function, mm_s2));
  if (bound_mm_s2 > 0 && mm_s2 > bound_mm_s2) {
    return failure(MinorCode::AccelerationLimit,
                   fmt::format("{}: {} mm/s² is above the mechanism's {} mm/s²", function, mm_s2, bound_mm_s2));
  }
  return {};
}

Expected<> Cam::set_path_accel_rise(double mm_s2) {
  return check_accel("SetPathAccelRise", mm_s2, device_ != nullptr ? device_->path_accel_rise_mm_s2 : 0).map([&] {
    settings_.accel_rise_mm_s2 = mm_s2;
  });
}

double Cam::path_accel_rise() const {
  return settings_.accel_rise_mm_s2;
}

Expected<> Cam::set_path_accel_fall(double mm_s2) {
  return check_accel("SetPathAccelFall", mm_s2, device_ != nullptr ? device_->path_accel_fall_mm_s2 : 0).map([&] {
    settings_.accel_fall_mm_s2 = mm_s2;
  });
}

double Cam::path_accel_fall() const {
  return settings_.accel_fall_mm_s2;
}

Expected<> Cam::set_joint_interp_speed(double percent) {
  if (!positive(percent) || percent > 100) {
    return refuse(fmt::format("SetJointInterpSpeed: {} percent must be above 0 and at most 100", percent));
  }
  settings_.joint_interp_percent = percent;
  return {};
}

double Cam::joint_interp_speed() const {
  return settings_.joint_interp_percent;
}

Expected<> Cam::set_path_tolerance(double mm) {
  if (!std::isfinite(mm) || mm < 0) return refuse(fmt::format("SetPathTolerance: {} mm must be 0 or more", mm));
  settings_.tolerance_mm = mm;
  return {};
}

double Cam::path_tolerance() const {
  return settings_.tolerance_mm;
}

Expected<> Cam::set_frames(const char* function, const Frames& frames) {
  return require_mechanism(function).and_then([&] { return supervisor_.require_rest(function); }).map([&] {
    supervisor_.set_frames(frames);
  });
}

Expected<> Cam::set_part_frame(const Frame& frame) {
  return check_frame(frame, "SetPartFrame").and_then([&] {
    return set_frames("SetPartFrame", {normalized(frame), frames().tool});
  });
}

Frame Cam::part_frame() const {
  return frames().part;
}

Expected<> Cam::set_tool_interface_frame(const Frame& frame) {
  return check_frame(frame, "SetToolInterfaceFrame").and_then([&] {
    return set_frames("SetToolInterfaceFrame", {frames().part, normalized(frame)});
  });
}

Frame Cam::tool_interface_frame() const {
  return frames().tool;
}

Expected<std::vector<double>> Cam::current_position() const {
  if (auto loaded = require_mechanism("GetCurrentPosition"); !loaded) return tl::unexpected(loaded.error());
  const CycleSample now = link_.history.latest();
  return std::vector<double>(now.position.begin(), now.position.begin() + now.joint_count);
}

Expected<> Cam::set_animation(bool) {
  // A client's call is its session's to answer (gateway/api): it streams to the connection that asks.
  return failure(
      MinorCode::UnsupportedOperation,
      "SetAnimation: joint values are streamed to a connection, and this call came through none; ask over the "
      "socket, or read the state");
}

}  // namespace rmac::gateway
