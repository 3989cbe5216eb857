#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/move_name.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

/// A jog without a limit on its way ends after so much, in mm or degrees.
constexpr double kFarAway = 1e5;
/// A joint so near to its limit, in mm or degrees, stands at it.
constexpr double kAtTheLimit = 1e-6;
/// To so much the way to a limit is found, in mm.
constexpr double kReachFound = 1e-3;

/// Where joint travel ends on one side.
double travel_end(const JointLimits& limits, double from, bool positive) {
  if (!(positive ? ends_above(limits) : ends_below(limits))) return from + (positive ? kFarAway : -kFarAway);
  return positive ? limits.max : limits.min;
}

/// The smallest rotation that brings Z to `axis`.
std::array<double, 4> turn_z_to(const Vector& axis) {
  const double norm = std::hypot(axis[0], axis[1], axis[2]);
  const double c = axis[2] / norm;
  if (c < -1 + 1e-12) return {0, 1, 0, 0};  // half a turn about X, of all that do
  const double w = std::sqrt((1 + c) / 2);
  return {w, -axis[1] / norm / (2 * w), axis[0] / norm / (2 * w), 0};
}

ToolPose shifted(const ToolPose& pose, const Vector& direction, double by) {
  return {plus(pose.tip, by, direction), pose.axis};
}

}  // namespace

Expected<> Cam::jog_joint(int joint, double distance) {
  const auto found = find_joint(joint, "JogJoint");
  if (!found) return tl::unexpected(found.error());
  if (!std::isfinite(distance) || distance == 0) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("JogJoint: the distance {} must be a number other than 0", distance));
  }
  if (auto free = check_limit_switches(*found, distance > 0); !free) return free;
  const ServoStatus now = link_.status.read();
  JointTargetGeometry target{{now.position_set.begin(), now.position_set.begin() + device_->joints.size()}};
  target.joints[*found] += distance;
  return supervisor_.run_positioning(make_joint_move(kPositioningMoveId, target, now.position_set));
}

Expected<> Cam::check_limit_switches(std::size_t joint, bool positive) const {
  const std::uint64_t on = link_.history.latest().inputs;
  for (const ServoLimit& limit : supervisor_.mechanism()->loop->parts().limits) {
    if (limit.joint != joint || (limit.direction > 0) != positive || (on & limit.input) == 0) continue;
    return failure(MinorCode::TravelLimit,
                   fmt::format("JogJoint: joint {} stands on its limit switch at the {} end; jog the other way",
                               device_->joints[joint].limits.name, positive ? "positive" : "negative"));
  }
  return {};
}

Expected<> Cam::jog_joint_at(int joint, double velocity) {
  const auto found = find_joint(joint, "JogJoint");
  if (!found) return tl::unexpected(found.error());
  const JointLimits& limits = device_->joints[*found].limits;
  const bool positive = velocity > 0;
  return jog_at("JogJoint", {joint, positive, limits.max_speed}, velocity, [&]() -> Expected<Move> {
    if (auto free = check_limit_switches(*found, positive); !free) return tl::unexpected(free.error());
    const ServoStatus now = link_.status.read();
    const double from = now.position_set[*found];
    const double to = travel_end(limits, from, positive);
    if (!(std::abs(to - from) > kAtTheLimit) || (to > from) != positive) {
      return failure(MinorCode::TravelLimit,
                     fmt::format("JogJoint: joint {} stands at its limit of {}; jog the other way", limits.name, to));
    }
    JointTargetGeometry target{{now.position_set.begin(), now.position_set.begin() + device_->joints.size()}};
    target.joints[*found] = to;
    Move move = make_joint_move(kPositioningMoveId, target, now.position_set);
    move.joint_speed_fraction = 1;
    return move;
  });
}

Expected<Vector> Cam::part_direction(const char* function, const sdk::JogDirection& direction) const {
  const Vector& v = direction.vector;
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!std::isfinite(length) || !(length > 1e-9)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: the direction ({}, {}, {}) has no length", function, v[0], v[1], v[2]));
  }
  const Vector unit{v[0] / length, v[1] / length, v[2] / length};
  return direction.in_tool_frame ? rotate(turn_z_to(tool_pose_set().axis), unit) : unit;
}

Expected<> Cam::jog_path(const sdk::JogDirection& direction, double distance_mm) {
  if (auto loaded = require_mechanism("JogPath"); !loaded) return loaded;
  if (!std::isfinite(distance_mm) || distance_mm == 0) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("JogPath: the distance {} must be a number other than 0", distance_mm));
  }
  return part_direction("JogPath", direction).and_then([&](const Vector& way) {
    return supervisor_.run_positioning(make_straight_move(shifted(tool_pose_set(), way, distance_mm)));
  });
}

Expected<> Cam::jog_path_at(const sdk::JogDirection& direction, double velocity_mm_s) {
  if (auto loaded = require_mechanism("JogPath"); !loaded) return loaded;
  const double fastest = settings_.max_feedrate_mm_min / kSecondsPerMinute;
  return jog_at("JogPath", {direction, velocity_mm_s > 0, fastest}, velocity_mm_s, [&]() -> Expected<Move> {
    auto way = part_direction("JogPath", direction);
    if (!way) return tl::unexpected(way.error());
    if (velocity_mm_s < 0) way = Vector{-(*way)[0], -(*way)[1], -(*way)[2]};
    const auto reach = straight_reach(*way);
    if (!reach) return tl::unexpected(reach.error());
    Move move = make_straight_move(shifted(tool_pose_set(), *way, *reach));
    move.feed_mm_s = fastest;
    return move;
  });
}

Expected<double> Cam::straight_reach(const Vector& direction) const {
  const auto mechanism = supervisor_.mechanism();
  const ToolPose from = tool_pose_set();
  const ServoStatus now = link_.status.read();
  const Frames frames = this->frames();
  const auto try_length = [&](double mm) {
    PathBuilder builder(mechanism->planner_model);
    builder.restart({now.position_set.data(), now.joint_count}, frames);
    return builder.build(make_straight_move(shifted(from, direction, mm)));
  };
  double good = 0;
  double bad = kReachFound;
  auto refusal = try_length(bad);
  if (!refusal) return tl::unexpected(refusal.error());
  while (refusal && bad < kFarAway) {
    good = bad;
    bad *= 2;
    refusal = try_length(bad);
  }
  // What can be reached is a first part of the way, so halving finds its end.
  while (bad - good > kReachFound) {
    const double middle = (good + bad) / 2;
    (try_length(middle) ? good : bad) = middle;
  }
  return good;
}

Expected<> Cam::jog_at(const char* function, const Jog& jog, double velocity,
                       const std::function<Expected<Move>()>& begin) {
  const double speed = std::abs(velocity);
  if (!(speed <= jog.fastest)) {
    return failure(MinorCode::SpeedLimit, fmt::format("{}: the velocity {} is more than {}, the fastest that it can be",
                                                      function, velocity, jog.fastest));
  }
  const bool same = jog_ && jog_->what == jog.what && jog_->positive == jog.positive;
  if (speed == 0) return supervisor_.end_jog();
  if (same && supervisor_.renew_jog(speed / jog.fastest)) return {};
  return begin().and_then([&](const Move& move) {
    return supervisor_.run_positioning(move, speed / jog.fastest).map([&] { jog_ = jog; });
  });
}

}  // namespace rmac::gateway
