#include "gateway/rmac_cam/cam_positioning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/move_name.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

/// A jog without a limit on its way ends after so much, in mm or degrees.
constexpr double kFarAway = 1e5;
/// A joint so near to its limit, in mm or degrees, stands at it.
constexpr double kAtTheLimit = 1e-6;
/// Joints that nobody moved yet stand so much beside their places, in mm or degrees.
constexpr double kStandsWithin = 1e-2;
/// To so much the way to a limit is found, in mm or degrees.
constexpr double kReachFound = 1e-3;
/// So far before it a jog ends: at the very end of reach, joints that friction holds a micrometre beyond have no pose.
constexpr double kBesideReach = 1e-2;

double travel_end(const JointLimits& limits, double from, bool positive) {
  const bool bounded = positive ? ends_above(limits) : ends_below(limits);
  if (!bounded) return from + (positive ? kFarAway : -kFarAway);
  return positive ? limits.max : limits.min;
}

/// Where a jog ends. One by the whole way to a limit ends at it, and is not refused for where the joint stands.
double jog_end(const JointLimits& limits, double from, double distance) {
  const double to = from + distance;
  if (std::abs(distance) <= kStandsWithin) return to;
  if (ends_above(limits) && to > limits.max && to <= limits.max + kStandsWithin) return limits.max;
  if (ends_below(limits) && to < limits.min && to >= limits.min - kStandsWithin) return limits.min;
  return to;
}

}  // namespace

JointTargetGeometry CamPositioning::joints_now() const {
  const ServoStatus now = link_.status.read();
  return {{now.position_set.begin(), now.position_set.begin() + device_.get()->joints.size()}};
}

Expected<> CamPositioning::jog_joint(int joint, double distance) {
  const auto found = device_.find_joint(joint, "JogJoint");
  if (!found) return tl::unexpected(found.error());
  if (!std::isfinite(distance) || distance == 0) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("JogJoint: the distance {} must be a number other than 0", distance));
  }
  if (auto free = check_limit_switches(*found, distance > 0); !free) return free;
  const JointTargetGeometry now = joints_now();
  JointTargetGeometry target = now;
  double& end = target.joints[*found];
  end = jog_end(device_.get()->joints[*found].limits, end, distance);
  return supervisor_.jogging().run(maker_.joint_move(kPositioningMoveId, target, now.joints));
}

Expected<> CamPositioning::check_limit_switches(std::size_t joint, bool positive) const {
  const std::uint64_t on = link_.history.latest().inputs;
  for (const ServoLimit& limit : supervisor_.mechanism()->loop->parts().limits) {
    if (limit.joint != joint || (limit.direction > 0) != positive || (on & limit.input) == 0) continue;
    return failure(MinorCode::TravelLimit,
                   fmt::format("JogJoint: joint {} stands on its limit switch at the {} end; jog the other way",
                               device_.get()->joints[joint].limits.name, positive ? "positive" : "negative"));
  }
  return {};
}

Expected<Move> CamPositioning::move_to_end(std::size_t joint, bool positive) const {
  const JointLimits& limits = device_.get()->joints[joint].limits;
  const JointTargetGeometry now = joints_now();
  const double from = now.joints[joint];
  const double to = travel_end(limits, from, positive);
  if (!(std::abs(to - from) > kAtTheLimit) || (to > from) != positive) {
    return failure(MinorCode::TravelLimit,
                   fmt::format("JogJoint: joint {} stands at its limit of {}; jog the other way", limits.name, to));
  }
  const auto move_by = [&](double amount) {
    JointTargetGeometry target = now;
    target.joints[joint] = amount == std::abs(to - from) ? to : from + std::copysign(amount, to - from);
    Move move = maker_.joint_move(kPositioningMoveId, target, now.joints);
    move.joint_speed_fraction = 1;
    return move;
  };
  // Before the end of its travel a parallel machine may come to where the tool has no pose.
  return reach_of(move_by, std::abs(to - from)).map(move_by);
}

Expected<> CamPositioning::jog_joint_at(int joint, double velocity) {
  const auto found = device_.find_joint(joint, "JogJoint");
  if (!found) return tl::unexpected(found.error());
  const bool positive = velocity > 0;
  const double fastest = device_.get()->joints[*found].limits.max_speed;
  return jog_at("JogJoint", {joint, positive, fastest}, velocity, [&] {
    return check_limit_switches(*found, positive).and_then([&] { return move_to_end(*found, positive); });
  });
}

Expected<Vector> CamPositioning::part_direction(const sdk::JogDirection& direction) const {
  const Vector& v = direction.vector;
  const double length = norm(v);
  if (!std::isfinite(length) || !(length > 1e-9)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("JogPath: the direction ({}, {}, {}) has no length", v[0], v[1], v[2]));
  }
  const Vector way = scaled(1 / length, v);
  return direction.in_tool_frame ? rotate(frame_from_axis({}, tool_.in_part().axis).q, way) : way;
}

Move CamPositioning::move_by(const ToolPose& from, const Vector& direction, double mm) const {
  return maker_.straight_move({along(from.tip, mm, direction), from.axis});
}

Expected<> CamPositioning::jog_path(const sdk::JogDirection& direction, double distance_mm) {
  if (auto loaded = device_.require("JogPath"); !loaded) return loaded;
  if (!std::isfinite(distance_mm) || distance_mm == 0) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("JogPath: the distance {} must be a number other than 0", distance_mm));
  }
  return part_direction(direction).and_then(
      [&](const Vector& way) { return supervisor_.jogging().run(move_by(tool_.in_part(), way, distance_mm)); });
}

Expected<> CamPositioning::jog_path_at(const sdk::JogDirection& direction, double velocity_mm_s) {
  if (auto loaded = device_.require("JogPath"); !loaded) return loaded;
  const double fastest = path_.max_feed_mm_s();
  return jog_at("JogPath", {direction, velocity_mm_s > 0, fastest}, velocity_mm_s, [&]() -> Expected<Move> {
    auto way = part_direction(direction);
    if (!way) return tl::unexpected(way.error());
    if (velocity_mm_s < 0) way = scaled(-1, *way);
    const ToolPose from = tool_.in_part();
    const auto by = [&](double mm) {
      Move move = move_by(from, *way, mm);
      move.feed_mm_s = fastest;
      return move;
    };
    return reach_of(by, kFarAway).map(by);
  });
}

Expected<double> CamPositioning::reach_of(const std::function<Move(double)>& move_by, double most) const {
  const ServoStatus now = link_.status.read();
  const Frames frames = supervisor_.wishes().frames;
  PlannerModel model = supervisor_.mechanism()->planner_model;
  const auto try_length = [&](double length) {
    PathBuilder builder(model);
    builder.restart({now.position_set.data(), now.joint_count}, frames);
    return builder.build(move_by(length));
  };
  if (try_length(most)) return most;
  double good = 0;
  double bad = std::min(kReachFound + kBesideReach, most);
  auto refusal = try_length(bad);
  if (!refusal) return tl::unexpected(refusal.error());
  while (refusal && bad < most) {
    good = bad;
    bad = std::min(2 * bad, most);
    refusal = try_length(bad);
  }
  // What can be reached is a first part of the way, so halving finds its end.
  while (bad - good > kReachFound) {
    const double middle = (good + bad) / 2;
    (try_length(middle) ? good : bad) = middle;
  }
  // Whether it is the end of a joint's travel or of the poses shows where no joint ends.
  for (JointLimits& joint : model.joints) joint.limit_type = JointLimitType::Infinite;
  return try_length(bad) ? good : good - kBesideReach;
}

Expected<> CamPositioning::jog_at(const char* function, const Jog& jog, double velocity,
                                  const std::function<Expected<Move>()>& begin) {
  const double speed = std::abs(velocity);
  if (!(speed <= jog.fastest)) {
    return failure(MinorCode::SpeedLimit, fmt::format("{}: the velocity {} is more than {}, the fastest that it can be",
                                                      function, velocity, jog.fastest));
  }
  const bool same = jog_ && jog_->what == jog.what && jog_->positive == jog.positive;
  if (speed == 0) return supervisor_.jogging().end();
  if (same && supervisor_.jogging().renew(speed / jog.fastest)) return {};
  return begin().and_then(
      [&](const Move& move) { return supervisor_.jogging().run(move, speed / jog.fastest).map([&] { jog_ = jog; }); });
}

Expected<> CamPositioning::home() {
  if (auto loaded = device_.require("Home"); !loaded) return loaded;
  const sdk::DeviceObject& device = *device_.get();
  const bool by_drives = std::any_of(device.actuators.begin(), device.actuators.end(),
                                     [](const sdk::Actuator& actuator) { return actuator.homing_turn > 0; });
  if (by_drives && !supervisor_.mechanism()->virtual_mode()) {
    // No feed override slows the drives, so one of 0 that an operator set keeps them from it.
    return supervisor_.operating()
        .require_free("Home")
        .and_then([&] { return supervisor_.require_rest("Home"); })
        .and_then([&] {
          return supervisor_.command(
              [](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.start_homing(seen); });
        });
  }
  if (auto known = require_references("Home", link_.status.read().reference_lost, device_.get()); !known) return known;
  const JointTargetGeometry now = joints_now();
  const bool there =
      std::all_of(now.joints.begin(), now.joints.end(), [](double position) { return std::abs(position) < 1e-9; });
  if (there) return supervisor_.require_rest("Home");
  const JointTargetGeometry zero{std::vector<double>(now.joints.size(), 0.0)};
  return supervisor_.jogging().run(maker_.joint_move(kPositioningMoveId, zero, now.joints));
}

Expected<> CamPositioning::move_to_reference_point() {
  if (auto loaded = device_.require("MoveToReferencePoint"); !loaded) return loaded;
  if (auto known = require_references("MoveToReferencePoint", link_.status.read().reference_lost, device_.get());
      !known)
    return known;
  return supervisor_.jogging().run(maker_.straight_move({{0, 0, 0}, tool_.in_part().axis}));
}

Expected<std::vector<double>> CamPositioning::current_position() const {
  return device_.require("CurrentPosition").map([&] {
    const CycleSample now = link_.history.latest();
    return std::vector<double>(now.position.begin(), now.position.begin() + now.joint_count);
  });
}

}  // namespace rmac::gateway
