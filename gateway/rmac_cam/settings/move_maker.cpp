#include "gateway/rmac_cam/settings/move_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {

Move MoveMaker::path_move(std::int64_t id, const Geometry& geometry) const {
  const CamPathSettings::Values& path = path_.values();
  return {.id = id,
          .geometry = geometry,
          .feed_mm_s = path_.feed_mm_s(),
          .tolerance_mm = path.tolerance_mm,
          .orientation_tolerance_deg = path.orientation_tolerance_deg,
          .accel_rise_mm_s2 = path.accel_rise_mm_s2,
          .accel_fall_mm_s2 = path.accel_fall_mm_s2,
          .joint_speed_fraction = joints_.values().interp_percent / 100};
}

Move MoveMaker::joint_move(std::int64_t id, const JointTargetGeometry& target, std::span<const double> from) const {
  Move move = path_move(id, target);
  const CamJointSettings::Values& joints = joints_.values();
  // All joints go in proportion on a line in joint space, so a joint's bound is one along that line, whatever
  // SetPathAccelRise says of the tool tip.
  const std::size_t count = std::min({target.joints.size(), from.size(), joints.accel_rise.size()});
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) square += (target.joints[i] - from[i]) * (target.joints[i] - from[i]);
  move.accel_rise_mm_s2 = move.accel_fall_mm_s2 = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = std::abs(target.joints[i] - from[i]) / std::sqrt(square);
    if (!(share > 0)) continue;
    const auto tighten = [&](double& bound, double accel) {
      bound = bound > 0 ? std::min(bound, accel / share) : accel / share;
    };
    tighten(move.accel_rise_mm_s2, joints.accel_rise[i]);
    tighten(move.accel_fall_mm_s2, joints.accel_fall[i]);
  }
  return move;
}

Move MoveMaker::straight_move(const ToolPose& target) const {
  Move move = path_move(kPositioningMoveId, PathTargetGeometry{target});
  if (!(move.feed_mm_s > 0)) move.feed_mm_s = path_.max_feed_mm_s() * joints_.values().interp_percent / 100;
  return move;
}

Expected<Move> MoveMaker::path_move_at(const char* function, std::int64_t id, const Geometry& geometry,
                                       double speed_mm_s) const {
  if (auto loaded = device_.require(function); !loaded) return tl::unexpected(loaded.error());
  if (!std::isfinite(speed_mm_s) || !(speed_mm_s > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the speed must be above 0 mm/s", function));
  }
  if (const double fastest = path_.max_feed_mm_s(); speed_mm_s > fastest) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("{}: {} mm/s is above the maximum feed of {} mm/s", function, speed_mm_s, fastest));
  }
  Move move = path_move(id, geometry);
  move.feed_mm_s = speed_mm_s;
  return move;
}

Expected<> MoveMaker::check_joint_target(const char* function, const JointTargetGeometry& target, double speed) const {
  if (auto loaded = device_.require(function); !loaded) return loaded;
  const std::size_t count = device_.get()->joints.size();
  if (target.joints.size() != count) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} positions are given, and the mechanism has {} joints", function,
                               target.joints.size(), count));
  }
  if (!std::isfinite(speed) || !(speed > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the speed must be above 0", function));
  }
  return {};
}

double MoveMaker::duration_s(const JointTargetGeometry& target, std::span<const double> from, double speed) const {
  double linear = 0, all = 0;
  for (std::size_t j = 0; j < target.joints.size(); ++j) {
    const double way = target.joints[j] - from[j];
    all = std::hypot(all, way);
    if (device_.get()->joints[j].limits.type != JointType::Rotary) linear = std::hypot(linear, way);
  }
  return (linear > 0 ? linear : all) / speed;
}

Expected<Move> MoveMaker::joint_move_at(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                        std::span<const double> from, double speed) const {
  const double takes_s = duration_s(target, from, speed);
  Move move = joint_move(id, target, from);
  double fraction = 0;
  for (std::size_t j = 0; j < target.joints.size() && takes_s > 0; ++j) {
    const JointLimits& joint = device_.get()->joints[j].limits;
    const double wanted = std::abs(target.joints[j] - from[j]) / takes_s;
    if (wanted > joint.max_speed * (1 + 1e-12)) {
      return failure(MinorCode::SpeedLimit,
                     fmt::format("{}: joint {} would go at {:.6g} a second, and its limit is {:.6g}", function,
                                 joint.name, wanted, joint.max_speed));
    }
    fraction = std::max(fraction, wanted / joint.max_speed);
  }
  if (fraction > 0) move.joint_speed_fraction = std::min(fraction, 1.0);
  return move;
}

}  // namespace rmac::gateway
