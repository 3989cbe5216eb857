#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::sdk {

/// The frames that moves are given in: the part's in the machine's, and the tool tip's on the tool interface. They
/// change at rest, with an empty queue. Gateway thread only.
class FrameSettings {
 public:
  virtual ~FrameSettings() = default;

  virtual Expected<> set_part(const Frame& frame) = 0;
  [[nodiscard]] virtual Frame part() const = 0;
  virtual Expected<> set_tool_interface(const Frame& frame) = 0;
  [[nodiscard]] virtual Frame tool_interface() const = 0;
};

}  // namespace rmac::sdk
