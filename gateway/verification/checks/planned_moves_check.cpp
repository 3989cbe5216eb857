#include "gateway/verification/checks/planned_moves_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <optional>
#include <random>

#include "gateway/verification/checks/pose_bounds.hpp"
#include "rmac/motion/follower/plan_follower.hpp"
#include "rmac/motion/path_builder.hpp"
#include "rmac/motion/planner.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::verifier {
namespace {

constexpr double kPlanning_s = 10;                    ///< of CPU time, for a program of a few moves
constexpr double kStanding_s = 0.5;                   ///< without progress
constexpr double kLimits = 1.01;                      ///< of a joint's limits, from differences of its positions
constexpr double kOffTravel = 1e-5;                   ///< mm or degrees
constexpr double kOffLine_mm = 1e-5;                  ///< beside the tolerance
constexpr double kTolerance_mm = 0.05;                ///< of the corners that are rounded
constexpr double kLeastWay = 0.005, kMostWay = 0.05;  ///< of a joint's travel, from move to move

using Joints = std::vector<double>;

double process_time_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The part of each limit that a joint's last four positions make use of.
class Differences {
 public:
  Differences(const JointLimits& limits, double period_s, double at) : limits_(limits), dt_(period_s) { at_.fill(at); }
  /// What a joint does that it must not, in words.
  [[nodiscard]] std::optional<std::string> take(double position) {
    std::rotate(at_.begin(), at_.begin() + 1, at_.end());
    at_.back() = position;
    const auto& [a, b, c, d] = at_;
    const std::array<std::pair<const char*, double>, 3> parts{
        {{"speed", std::abs(d - c) / (dt_ * limits_.max_speed)},
         {"acceleration", std::abs(d - 2 * c + b) / (dt_ * dt_ * limits_.max_acceleration)},
         {"jerk", std::abs(d - 3 * c + 3 * b - a) / (dt_ * dt_ * dt_ * limits_.max_jerk)}}};
    for (const auto& [what, part] : parts) {
      if (!(part <= kLimits)) return fmt::format("is at {} of its {} limit", part, what);
    }
    const double below = ends_below(limits_) ? limits_.min - d : 0, above = ends_above(limits_) ? d - limits_.max : 0;
    if (!(std::max(below, above) <= kOffTravel)) return fmt::format("is {} beyond its travel", std::max(below, above));
    return std::nullopt;
  }

 private:
  const JointLimits& limits_;
  double dt_;
  std::array<double, 4> at_{};
};

class PlannedMovesCheck {
 public:
  explicit PlannedMovesCheck(const PlannedMovesCase& given)
      : given_(given),
        builder_(given.model),
        planner_(given.model, channel_),
        follower_(channel_, given.model.joints, given.model.period_s),
        joints_(given.start),
        random_(given.seed) {
    follower_.hold_at(joints_);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      differences_.emplace_back(given.model.joints[j], given.model.period_s, joints_[j]);
    }
  }

  tl::expected<PlannedMoves, CounterExample> run() {
    for (program_ = 0; program_ < given_.programs; ++program_) {
      if (auto fine = misdeed_or(given_.misdeed, run_program()); !fine) return tl::unexpected(fine.error());
    }
    return count_;
  }

 private:
  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  bool by_chance(double share) { return random(0, 1) < share; }

  /// Joints some way from others, within their travel.
  Joints near(std::span<const double> joints) {
    const double way = random(kLeastWay, kMostWay);
    Joints result;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const auto& [min, max] = given_.ranges[j];
      result.push_back(std::clamp(joints[j] + random(-way, way) * (max - min), min, max));
    }
    return result;
  }
  ToolPose pose_near(std::span<const double> joints) {
    return pose_of(*given_.model.kinematics, near(joints), frames_.tool);
  }

  Geometry joint_target() {
    Joints joints;
    for (const auto& [min, max] : given_.ranges) joints.push_back(random(min, max));
    return JointTargetGeometry{joints};
  }
  /// Of third degree, its tool axis along with it: to joints nearby, not quite straight.
  Geometry nurbs() {
    constexpr int kDegree = 3, kPoints = 6;
    constexpr double kBend = 0.1;
    const std::span<const double> from = builder_.end_joints();
    const Joints to = near(from);
    NurbsGeometry geometry{NurbsSpace::Pose, {kDegree, 6, {}, {}, {}}};
    for (int i = 0; i < kPoints; ++i) {
      ToolPose pose = builder_.end_pose();
      Joints joints;
      for (std::size_t j = 0; i > 0 && j < from.size(); ++j) {
        joints.push_back(from[j] +
                         (to[j] - from[j]) * (static_cast<double>(i) / (kPoints - 1) + random(-kBend, kBend)));
      }
      if (i > 0) pose = pose_of(*given_.model.kinematics, joints, frames_.tool);
      geometry.curve.points.push_back(named_pose("", pose).numbers);
    }
    for (int i = 0; i < kPoints + kDegree + 1; ++i) {
      geometry.curve.knots.push_back(std::clamp(i - kDegree, 0, kPoints - kDegree));
    }
    return geometry;
  }
  Geometry any_geometry() {
    constexpr double kTargets = 0.2, kCurves = 0.3;
    if (by_chance(kTargets)) return joint_target();
    if (by_chance(kCurves)) return nurbs();
    return LineGeometry{builder_.end_pose(), pose_near(builder_.end_joints())};
  }

  Checked run_program() {
    constexpr int kMoves = 6;
    frames_ = {Frame{}, given_.tools[static_cast<std::size_t>(program_) % given_.tools.size()]};
    builder_.restart(joints_, frames_);
    moves_.clear();
    planned_cpu_s_ = 0;
    for (int i = 0; i < kMoves; ++i) {
      Move move;
      move.id = static_cast<std::int64_t>(moves_.size());
      move.geometry = i == 0 ? joint_target() : any_geometry();
      move.feed_mm_s = given_.model.max_feed_mm_s * random(0.05, 1);
      move.tolerance_mm = by_chance(0.5) ? kTolerance_mm : 0;
      auto segments = builder_.build(move);
      if (!segments) {
        ++count_.refused;
        continue;
      }
      ++count_.run;
      moves_.push_back(std::move(move));
      planner_.add(std::move(*segments));
    }
    planner_.command(PathCommand::Run);
    return come_to_rest();
  }

  Checked come_to_rest() {
    const std::int64_t most = std::llround(kStanding_s / given_.model.period_s);
    for (std::int64_t standing = 0; standing < most; standing = setpoint_.moving ? 0 : standing + 1) {
      if (auto fine = plan().and_then([&] { return cycle(); }); !fine) return fine;
      step();
      if (planner_.moves_left() == 0 && planner_.idle(progress()) && planner_.at_rest(progress())) return is_at_end();
    }
    return fault("it stands in mid-path for half a second, and the planner finds no way on");
  }

  Checked is_at_end() const {
    const auto end = builder_.end_joints();
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (!(std::abs(joints_[j] - end[j]) <= kOffTravel)) {
        return fault(fmt::format("joint \"{}\" ends at {} instead of {}", name(j), joints_[j], end[j]));
      }
    }
    return {};
  }

  void step() {
    const double begun_s = process_time_s();
    planner_.step(progress());
    planned_cpu_s_ += process_time_s() - begun_s;
  }

  Checked plan() {
    while (!planner_.idle(progress())) {
      step();
      if (planned_cpu_s_ > kPlanning_s) {
        return fault(fmt::format("the planner works on it for more than {} s", kPlanning_s));
      }
    }
    return {};
  }

  Checked cycle() {
    follower_.sample(++cycle_, setpoint_);
    if (follower_.off_path()) return fault(describe(follower_.departure()));
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      joints_[j] = setpoint_.position[j];
      if (const auto misdeed = differences_[j].take(joints_[j])) {
        return fault(fmt::format("joint \"{}\" {}", name(j), *misdeed));
      }
    }
    if (const double off = off_line(); off > kTolerance_mm + kOffLine_mm) {
      return fault(fmt::format("the tool is {} mm off its line; {} are allowed", off, kTolerance_mm));
    }
    return given_.follow ? given_.follow(setpoint_, frames_) : Checked();
  }

  [[nodiscard]] double off_line() const {
    if (!setpoint_.moving) return 0;
    const auto* line = std::get_if<LineGeometry>(&moves_[static_cast<std::size_t>(setpoint_.move_id)].geometry);
    if (line == nullptr) return 0;
    ToolPose pose;
    given_.model.kinematics->forward(joints_, frames_.tool, pose);
    const Vector way = difference(line->end.tip, line->start.tip), from = difference(pose.tip, line->start.tip);
    const double length2 = dot(way, way);
    const double part = length2 > 0 ? std::clamp(dot(from, way) / length2, 0.0, 1.0) : 0;
    return norm(along(from, -part, way));
  }

  [[nodiscard]] std::string describe(const PathDeparture& departure) const {
    switch (departure.cause) {
      case PathDeparture::Cause::NoSolution:
        return "the inverse has no joints for a pose of the path that it had when it was planned";
      case PathDeparture::Cause::NotANumber:
        return "the inverse gives something that is no number in mid-path";
      case PathDeparture::Cause::Jump:
        return fmt::format("the inverse has joint \"{}\" jump in mid-path", name(departure.joint));
      case PathDeparture::Cause::Stop:
        break;
    }
    return "the path was left";
  }

  [[nodiscard]] const std::string& name(std::size_t joint) const { return given_.model.joints[joint].name; }
  [[nodiscard]] tl::unexpected<CounterExample> fault(std::string what) const {
    std::vector<NamedNumbers> values{named("joints", joints_), named_tool(frames_.tool)};
    const auto at = static_cast<std::size_t>(setpoint_.move_id);
    if (at < moves_.size()) {
      values.push_back({"feed", {moves_[at].feed_mm_s}});
      if (const auto* line = std::get_if<LineGeometry>(&moves_[at].geometry)) {
        values.push_back(named_pose("line from", line->start));
        values.push_back(named_pose("line to", line->end));
      } else if (const auto* target = std::get_if<JointTargetGeometry>(&moves_[at].geometry)) {
        values.push_back(named("target", target->joints));
      }
    }
    return found("planned moves", std::move(what), program_, std::move(values));
  }
  [[nodiscard]] ServoProgress progress() const {
    return {cycle_, follower_.accepted_plan(), follower_.last_refused(), follower_.departure()};
  }

  const PlannedMovesCase& given_;
  PlanChannel channel_;
  PathBuilder builder_;
  Planner planner_;
  PlanFollower follower_;
  std::vector<Differences> differences_;
  Joints joints_;  ///< as set in the last cycle
  std::mt19937_64 random_;
  PlannedMoves count_;
  std::int64_t cycle_ = 0;
  Setpoint setpoint_;

  int program_ = 0;  ///< at hand, with those below
  Frames frames_;
  std::vector<Move> moves_;  ///< by their ids
  double planned_cpu_s_ = 0;
};

}  // namespace

tl::expected<PlannedMoves, CounterExample> check_planned_moves(const PlannedMovesCase& given) {
  return PlannedMovesCheck(given).run();
}

}  // namespace rmac::verifier
