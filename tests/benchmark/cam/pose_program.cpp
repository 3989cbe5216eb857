#include "pose_program.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../motion/shapes.hpp"
#include "curves/vector.hpp"
#include "judge.hpp"

namespace rmac::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vector turned(const Vector& from, const Vector& to, double part) {
  const double angle = std::atan2(norm(cross(from, to)), dot(from, to));
  if (angle < 1e-12) return from;
  return scaled(1 / std::sin(angle), along(scaled(std::sin((1 - part) * angle), from), std::sin(part * angle), to));
}

double angle_deg(const Vector& a, const Vector& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) / kDegree;
}

double longest(const std::vector<ToolPose>& poses) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) most = std::max(most, distance(poses[i].tip, poses[i + 1].tip));
  return most;
}

struct Off {
  double tip_mm = 0, axis_deg = 0;
};

/// How far poses that go along a polyline, forward only, are from it: the tip from the nearest place, and the axis from
/// what it is there, on the great circle between both corners.
Off off(const std::vector<ToolPose>& poses, const std::vector<ToolPose>& polyline) {
  // As far ahead as the next of them may be, and more.
  const double most_mm = 2 + 1.5 * std::max(longest(poses), longest(polyline));
  Off worst;
  std::size_t line = 0;
  for (const ToolPose& pose : poses) {
    double least = 1e300, ahead_mm = 0, place = 0;
    std::size_t best = line;
    for (std::size_t k = line; k + 1 < polyline.size() && ahead_mm < most_mm; ++k) {
      const Vector& from = polyline[k].tip;
      const Vector way = difference(polyline[k + 1].tip, from);
      const double part = std::clamp(dot(difference(pose.tip, from), way) / std::max(dot(way, way), 1e-300), 0.0, 1.0);
      const double here = distance(pose.tip, along(from, part, way));
      if (here < least) {
        least = here;
        best = k;
        place = part;
      }
      ahead_mm += norm(way);
    }
    worst.tip_mm = std::max(worst.tip_mm, least);
    worst.axis_deg =
        std::max(worst.axis_deg, angle_deg(pose.axis, turned(polyline[best].axis, polyline[best + 1].axis, place)));
    line = best;
  }
  return worst;
}

tl::expected<std::vector<double>, std::string> start_joints(const PlannerModel& model, const ToolPose& pose) {
  std::vector<double> seed(model.joints.size(), 0.0), joints(model.joints.size(), 0.0);
  if (model.kinematics->inverse(pose, {}, seed, joints) != KinematicsStatus::Ok)
    return tl::unexpected(std::string("its start is out of reach"));
  return joints;
}

}  // namespace

std::vector<ToolPose> corners_of(const PoseShape& shape, int lines) {
  std::vector<ToolPose> corners;
  for (int k = 0; k <= lines; ++k) corners.push_back(shape(static_cast<double>(k) / lines));
  return corners;
}

std::vector<ToolPose> rounded(std::vector<ToolPose> corners, double to_mm, double to_axis) {
  const auto round_to = [](Vector& values, double to) {
    for (double& value : values) value = std::round(value / to) * to;
  };
  for (ToolPose& corner : corners) {
    round_to(corner.tip, to_mm);
    round_to(corner.axis, to_axis);
  }
  corners.erase(
      std::unique(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.tip == b.tip; }),
      corners.end());
  return corners;
}

Nurbs interpolated(const PoseShape& shape) {
  constexpr int kDegreeOfSpline = 5, kPoints = 120;
  Nurbs pose = interpolated([&](double t) { return shape(t).tip; }, 1, kDegreeOfSpline, kPoints);
  const Nurbs axis = interpolated([&](double t) { return shape(t).axis; }, 1, kDegreeOfSpline, kPoints);
  pose.dimension = 6;
  for (std::size_t i = 0; i < pose.points.size(); ++i)
    pose.points[i].insert(pose.points[i].end(), axis.points[i].begin(), axis.points[i].end());
  return pose;
}

tl::expected<PoseMachined, std::string> machine(const PoseProgram& program, const PlannerModel& model) {
  const auto& corners = program.corners;
  const auto start = start_joints(model, corners.front());
  if (!start) return tl::unexpected(start.error());
  Judge judge(model, *start);
  std::vector<ToolPose> way;
  judge.on_joints = [&](std::span<const double> joints) { model.kinematics->forward(joints, {}, way.emplace_back()); };
  Move move;
  move.feed_mm_s = program.feed_mm_s;
  move.tolerance_mm = program.tolerance_mm;
  move.orientation_tolerance_deg = program.tolerance_deg;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    move.id = static_cast<std::int64_t>(i) + 1;
    move.geometry = LineGeometry{corners[i], corners[i + 1]};
    if (auto queued = judge.drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  }
  return judge.run().map([&](const Machined& machined) {
    PoseMachined done{machined};
    // Of the tool from the lines, and of each corner from the tool's way.
    const Off there = off(way, corners), back = off(corners, way);
    done.deviation_mm = std::max(there.tip_mm, back.tip_mm);
    done.axis_deg = std::max(there.axis_deg, back.axis_deg);
    return done;
  });
}

tl::expected<Machined, std::string> machine(const Nurbs& pose, const PoseProgram& as, const PlannerModel& model) {
  const auto start = start_joints(model, as.corners.front());
  if (!start) return tl::unexpected(start.error());
  Judge judge(model, *start);
  Move move;
  move.id = 1;
  move.feed_mm_s = as.feed_mm_s;
  move.geometry = NurbsGeometry{NurbsSpace::Pose, pose};
  if (auto queued = judge.drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  return judge.run();
}

}  // namespace rmac::bench
