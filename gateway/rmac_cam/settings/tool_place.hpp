#pragma once

#include <span>

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/servo/servo_link.hpp"

namespace rmac::gateway {

/// Where the tool of the mechanism in force is, under the frames in force. There must be a mechanism. Gateway thread
/// only.
class ToolPlace {
 public:
  ToolPlace(MotionSupervisor& supervisor, const ServoLink& link) : supervisor_(supervisor), link_(link) {}

  /// Where the tool is meant to be now, in the part frame; and in the machine frame.
  [[nodiscard]] ToolPose in_part() const;
  [[nodiscard]] ToolPose in_machine() const;
  /// Where it is with these joints, in the part frame.
  [[nodiscard]] ToolPose at(std::span<const double> joints) const;

 private:
  MotionSupervisor& supervisor_;
  const ServoLink& link_;
};

}  // namespace rmac::gateway
