#include "gateway/rmac_cam/cam_cmm_moves.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

/// The same attitude comes back with every turn: of those places within the travel, the nearest to `from` in the sense
/// that is asked for.
std::optional<double> nearest_turn(const JointLimits& limits, double from, double position, int direction) {
  constexpr double kTurn = 360, kThere = 1e-9;
  std::optional<double> nearest;
  const double first = position + kTurn * std::round((from - position) / kTurn);
  for (const double place : {first - kTurn, first, first + kTurn}) {
    const double way = place - from;
    const bool sense = direction == 0 || std::abs(way) < kThere || (direction > 0) == (way > 0);
    const bool nearer = !nearest || std::abs(way) < std::abs(*nearest - from);
    if (within_travel(limits, place) && sense && nearer) nearest = place;
  }
  return nearest;
}

const char* sense_of(int direction) {
  if (direction == 0) return "either way";
  return direction > 0 ? "in the positive sense" : "in the negative sense";
}

}  // namespace

Expected<> CamCmmMoves::add_path_move(const char* function, std::int64_t id, const Geometry& geometry, double speed) {
  return maker_.path_move_at(function, id, geometry, speed)
      .and_then([&](const Move& move) { return supervisor_.add_move(move); })
      .map([](bool) {});
}

Expected<> CamCmmMoves::to_point(std::int64_t id, const Vector& point, double speed) {
  return supervisor_.prepare_move().and_then([&] {
    const ToolPose& from = supervisor_.mechanism()->builder.end_pose();
    return add_path_move("MoveToXYZ", id, PathTargetGeometry{{point, from.axis}}, speed);
  });
}

Expected<> CamCmmMoves::in_arc(std::int64_t id, const sdk::ArcTo& arc, double speed) {
  return supervisor_.prepare_move().and_then([&] {
    constexpr double kSamePoint_mm = 1e-6;
    const ToolPose from = supervisor_.mechanism()->builder.end_pose();
    const bool closed = rmac::distance(arc.end, from.tip) < kSamePoint_mm;
    const ArcGeometry geometry{arc.center, arc.normal, 1, closed, from, {arc.end, from.axis}};
    return add_path_move("MoveInArc", id, geometry, speed);
  });
}

Expected<> CamCmmMoves::add_joint_move(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                       double speed) {
  return maker_.check_joint_target(function, target, speed)
      .and_then([&] { return supervisor_.prepare_move(); })
      .and_then([&] {
        return maker_.joint_move_at(function, id, target, supervisor_.mechanism()->builder.end_joints(), speed);
      })
      .and_then([&](const Move& move) { return supervisor_.add_move(move); })
      .map([](bool) {});
}

Expected<> CamCmmMoves::all_joints(std::int64_t id, std::vector<double> joints, double speed) {
  return add_joint_move("MoveAllAxis", id, JointTargetGeometry{std::move(joints)}, speed);
}

Expected<> CamCmmMoves::rotary_joint(std::int64_t id, int joint, double position, int direction, double speed) {
  constexpr const char* kFunction = "MoveRotaryAxis";
  const auto found = device_.find_joint(joint, kFunction);
  if (!found) return tl::unexpected(found.error());
  const JointLimits& limits = device_.get()->joints[*found].limits;
  if (limits.type != JointType::Rotary) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: joint {} ({}) does not turn; use MoveAllAxis", kFunction, joint, limits.name));
  }
  if (auto ready = supervisor_.prepare_move(); !ready) return ready;
  const std::span<const double> end = supervisor_.mechanism()->builder.end_joints();
  JointTargetGeometry target{{end.begin(), end.end()}};
  const double from = target.joints[*found];
  const auto place = nearest_turn(limits, from, position, direction);
  if (!place) {
    return failure(
        MinorCode::TravelLimit,
        fmt::format("{}: joint {} cannot turn from {:.6g} to {:.6g} degrees {} within its travel from {:.6g} "
                    "to {:.6g}",
                    kFunction, limits.name, from, position, sense_of(direction), limits.min, limits.max));
  }
  target.joints[*found] = *place;
  return add_joint_move(kFunction, id, target, speed);
}

}  // namespace rmac::gateway
