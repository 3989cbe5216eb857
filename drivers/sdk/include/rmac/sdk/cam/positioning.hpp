#pragma once

#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::sdk {

/// A direction of jogging, of any length but zero: in the part frame, or in the tool's. The tool's frame has the tool
/// axis for its Z, and is the part frame turned by the smallest rotation that brings Z there.
struct JogDirection {
  Vector vector{};
  bool in_tool_frame = false;

  bool operator==(const JogDirection&) const = default;
};

/// Moves outside of the cycle, from rest and with an empty queue: jogs and the ways to known places. Gateway thread
/// only.
class Positioning {
 public:
  virtual ~Positioning() = default;

  /// Moves one joint by a distance, at the joint interpolation speed.
  virtual Expected<> jog_joint(int joint, double distance) = 0;
  /// Moves one joint at a velocity, up to its limit at most, for 200 ms; called again within that time, with the
  /// velocity that is wanted now, it goes on.
  virtual Expected<> jog_joint_at(int joint, double velocity) = 0;
  /// Moves the tool tip straight by a distance, at the feed in force; the tool axis stays as it is.
  virtual Expected<> jog_path(const JogDirection& direction, double distance_mm) = 0;
  /// Likewise at a velocity in mm/s, as `jog_joint_at`, as far as every joint can go.
  virtual Expected<> jog_path_at(const JogDirection& direction, double velocity_mm_s) = 0;
  /// Has those drives look for home that do so by themselves; where there are none, and in virtual mode, moves all
  /// joints to zero.
  virtual Expected<> home() = 0;
  /// Moves the tool tip straight to the zero of the part frame; the tool axis stays as it is.
  virtual Expected<> move_to_reference_point() = 0;
  /// Measured joint positions.
  [[nodiscard]] virtual Expected<std::vector<double>> current_position() const = 0;
};

}  // namespace rmac::sdk
