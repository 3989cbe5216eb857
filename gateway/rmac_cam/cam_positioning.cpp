#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
Expected<std::size_t> Cam::find_joint(int joint, const char* function) const {
  if (auto loaded = require_mechanism(function); !loaded) return tl::unexpected(loaded.error());
  const auto count = static_cast<int>(device_->joints.size());
  if (joint >= 0 && joint < count) return static_cast<std::size_t>(joint);
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: there is no joint {}; joints are 0 to {}", function, joint, count - 1));
}

Expected<> Cam::set_joint_accel(std::vector<double>& accel, const char* function, int joint, double value) {
  const auto found = find_joint(joint, function);
  if (!found) return tl::unexpected(found.error());
  return check_accel(function, value, device_->joints[*found].limits.max_acceleration).map([&] {
    accel[*found] = value;
  });
}

Expected<> Cam::set_joint_accel_rise(int joint, double value) {
  return set_joint_accel(settings_.joint_accel_rise, "SetJointAccelRise", joint, value);
}

Expected<double> Cam::joint_accel_rise(int joint) const {
  return find_joint(joint, "GetJointAccelRise").map([&](std::size_t found) {
    return settings_.joint_accel_rise[found];
  });
}

Expected<> Cam::set_joint_accel_fall(int joint, double value) {
  return set_joint_accel(settings_.joint_accel_fall, "SetJointAccelFall", joint, value);
}

Expected<double> Cam::joint_accel_fall(int joint) const {
  return find_joint(joint, "GetJointAccelFall").map([&](std::size_t found) {
    return settings_.joint_accel_fall[found];
  });
}

Move Cam::make_joint_move(std::int64_t id, const JointTargetGeometry& target, std::span<const double> from) const {
  Move move = make_move(id, target);
  // All joints go in proportion on a line in joint space, so a joint's bound is one along that line, whatever
  // SetPathAccelRise says of the tool tip.
  const std::size_t count = std::min({target.joints.size(), from.size(), settings_.joint_accel_rise.size()});
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) square += (target.joints[i] - from[i]) * (target.joints[i] - from[i]);
  move.accel_rise_mm_s2 = move.accel_fall_mm_s2 = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = std::abs(target.joints[i] - from[i]) / std::sqrt(square);
    if (!(share > 0)) continue;
    const auto tighten = [&](double& bound, double accel) {
      bound = bound > 0 ? std::min(bound, accel / share) : accel / share;
    };
    tighten(move.accel_rise_mm_s2, settings_.joint_accel_rise[i]);
    tighten(move.accel_fall_mm_s2, settings_.joint_accel_fall[i]);
  }
  return move;
}

Expected<> Cam::home() {
  if (auto loaded = require_mechanism("Home"); !loaded) return loaded;
  const bool by_drives = std::any_of(device_->actuators.begin(), device_->actuators.end(),
                                     [](const sdk::Actuator& actuator) { return actuator.homing_turn > 0; });
  if (by_drives && !supervisor_.mechanism()->virtual_mode()) {
    return supervisor_.require_rest("Home").and_then([&] {
      return supervisor_.command(
          [](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.start_homing(seen); });
    });
  }
  const std::size_t count = device_->joints.size();
  const ServoStatus now = link_.status.read();
  const bool there =
      std::all_of(now.position_set.begin(), now.position_set.begin() + static_cast<std::ptrdiff_t>(count),
                  [](double position) { return std::abs(position) < 1e-9; });
  if (there) return supervisor_.require_rest("Home");
  return supervisor_.jogging().run(
      make_joint_move(kPositioningMoveId, JointTargetGeometry{std::vector<double>(count, 0.0)}, now.position_set));
}

ToolPose Cam::tool_pose_in_machine() const {
  // Not from a sample: frames set just now are not in it yet.
  const ServoStatus now = link_.status.read();
  const Frames frames = this->frames();
  ToolPose at;
  supervisor_.mechanism()->planner_model.kinematics->forward({now.position_set.data(), now.joint_count}, frames.tool,
                                                             at);
  return at;
}

ToolPose Cam::tool_pose_set() const {
  return apply_to_pose(inverse(frames().part), tool_pose_in_machine());
}

ToolPose Cam::tool_pose_at(std::span<const double> joints) const {
  const Frames frames = this->frames();
  ToolPose at;
  supervisor_.mechanism()->planner_model.kinematics->forward(joints, frames.tool, at);
  return apply_to_pose(inverse(frames.part), at);
}

Expected<Move> Cam::path_move_at(const char* function, std::int64_t id, const Geometry& geometry,
                                 double speed_mm_s) const {
  if (auto loaded = require_mechanism(function); !loaded) return tl::unexpected(loaded.error());
  if (!std::isfinite(speed_mm_s) || !(speed_mm_s > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the speed must be above 0 mm/s", function));
  }
  if (const double fastest = settings_.max_feedrate_mm_min / kSecondsPerMinute; speed_mm_s > fastest) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("{}: {} mm/s is above the maximum feed of {} mm/s", function, speed_mm_s, fastest));
  }
  Move move = make_move(id, geometry);
  move.feed_mm_s = speed_mm_s;
  return move;
}

Expected<> Cam::queue_joints_at(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                double speed) {
  if (auto loaded = require_mechanism(function); !loaded) return loaded;
  const std::size_t count = device_->joints.size();
  if (target.joints.size() != count) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} positions are given, and the mechanism has {} joints", function,
                               target.joints.size(), count));
  }
  if (!std::isfinite(speed) || !(speed > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the speed must be above 0", function));
  }
  if (auto ready = supervisor_.prepare_move(); !ready) return ready;
  const std::span<const double> from = supervisor_.mechanism()->builder.end_joints();
  double linear = 0, all = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const double way = target.joints[j] - from[j];
    all = std::hypot(all, way);
    if (device_->joints[j].limits.type != JointType::Rotary) linear = std::hypot(linear, way);
  }
  const double takes_s = (linear > 0 ? linear : all) / speed;
  Move move = make_joint_move(id, target, from);
  double fraction = 0;
  for (std::size_t j = 0; j < count && takes_s > 0; ++j) {
    const JointLimits& joint = device_->joints[j].limits;
    const double wanted = std::abs(target.joints[j] - from[j]) / takes_s;
    if (wanted > joint.max_speed * (1 + 1e-12)) {
      return failure(MinorCode::SpeedLimit,
                     fmt::format("{}: joint {} would go at {:.6g} a second, and its limit is {:.6g}", function,
                                 joint.name, wanted, joint.max_speed));
    }
    fraction = std::max(fraction, wanted / joint.max_speed);
  }
  if (fraction > 0) move.joint_speed_fraction = std::min(fraction, 1.0);
  return supervisor_.add_move(move).map([](bool) {});
}

Move Cam::make_straight_move(const ToolPose& target) const {
  Move move = make_move(kPositioningMoveId, PathTargetGeometry{target});
  // Without a feed in force, as fast as joint moves are allowed to be.
  if (!(move.feed_mm_s > 0))
    move.feed_mm_s = settings_.max_feedrate_mm_min / kSecondsPerMinute * settings_.joint_interp_percent / 100;
  return move;
}

Expected<> Cam::move_to_reference_point() {
  if (auto loaded = require_mechanism("MoveToReferencePoint"); !loaded) return loaded;
  return supervisor_.jogging().run(make_straight_move({{0, 0, 0}, tool_pose_set().axis}));
}

}  // namespace rmac::gateway
