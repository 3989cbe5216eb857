#pragma once

#include <optional>
#include <span>

#include "path/travel.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Refuses a feed, joint speed, tolerance or acceleration that makes no sense; the message names the value and the
/// rule.
[[nodiscard]] Expected<> check_demand(const Move& move, bool joint_move);

/// Why a segment cannot be travelled at path length `s`: no joint values give its pose there.
[[nodiscard]] Error unreachable(const Move& move, const PathSegment& segment, KinematicsStatus status, double s);

/// A joint leaves its travel on the segment that begins at `s_begin_mm` of the move.
[[nodiscard]] Error beyond_travel(const Move& move, const TravelOffence& offence, const JointLimits& joint,
                                  double s_begin_mm);

/// The curve `near` passes the pole so that the tool axis would leave the programmed one by `deviation` rad, `s_mm`
/// along the move.
[[nodiscard]] Error beyond_pole(const Move& move, const Curve& near, double s_mm, double deviation);

/// A segment through the joints' space has no pose of the tool at path length `s`.
[[nodiscard]] Error without_pose(const Move& move, const PathSegment& segment, double s,
                                 const std::vector<JointLimits>& joints);

/// A move of the tool begins at joints that have no pose.
[[nodiscard]] Error begins_without_pose(const Move& move, std::span<const double> positions,
                                        const std::vector<JointLimits>& joints);

/// A move of a tool that the kinematics does not take.
[[nodiscard]] Error not_taken(const Move& move, const Frame& tool);

}  // namespace rmac
