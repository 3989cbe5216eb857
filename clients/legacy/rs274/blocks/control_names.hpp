#pragma once

#include <optional>
#include <string_view>

namespace rmac::rs274 {

/// The names that LinuxCNC's manual gives to what the control tells a program of itself, those apart that a return
/// sets. `Unknown`: what nobody knows before a machine runs the program.
enum class ControlName {
  Unknown,
  X,
  Y,
  Z,
  Metric,
  Imperial,
  Absolute,
  Incremental,
  InverseTime,
  UnitsPerMinute,
  UnitsPerTurn,
  Plane,
  MotionMode,
  CoordinateSystem,
  ToolOffset,
  RetractToR,
  RetractToOldZ,
  SpindleRpmMode,
  SpindleCssMode,
  AbsoluteCentres,
  LatheDiameter,
  LatheRadius,
  SpindleOn,
  SpindleClockwise,
  Mist,
  Flood,
  SpeedOverride,
  FeedOverride,
  AdaptiveFeed,
  FeedHold,
  Feed,
  Rpm,
  CurrentTool,
  SelectedTool,
  Task,
  CallLevel,
  Line
};

/// `name` in capitals, as in Line::text(); none where a program may set it.
[[nodiscard]] std::optional<ControlName> control_name(std::string_view name) noexcept;

}  // namespace rmac::rs274
