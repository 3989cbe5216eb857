#pragma once

#include <optional>
#include <span>
#include <string>

#include "gateway/verification/checks/check.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::verifier {

/// How far the forward of an inverse may be off the pose asked for.
struct PoseBounds {
  double tip_mm, axis_rad;
};
/// Of a pose that joints give: rounding.
inline constexpr PoseBounds kExact{1e-9, 1e-9};
/// Of a pose that may lie beyond the reach: where a geometry is given poses of few digits, as programs write them, it
/// may take them for those that it reaches.
inline constexpr PoseBounds kAsWritten{1e-5, 1e-5};

/// More solutions of a pose than this are not looked at.
inline constexpr std::size_t kMostSolutions = 16;

/// By how much the forward of `joints` misses the pose, in words; nothing where it does not.
[[nodiscard]] std::optional<std::string> miss(const Kinematics& kinematics, std::span<const double> joints,
                                              const Frame& tool, const ToolPose& pose,
                                              const PoseBounds& bounds = kExact);

[[nodiscard]] NamedNumbers named_pose(const char* name, const ToolPose& pose);
[[nodiscard]] NamedNumbers named_tool(const Frame& tool);

}  // namespace rmac::verifier
