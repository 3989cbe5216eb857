#pragma once

#include <vector>

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/settings/move_maker.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::gateway {

/// How messages name a tool.
[[nodiscard]] std::string described(const Tool& tool);

/// Makes the steps of a tool change, as the queue takes them. There must be a mechanism. Gateway thread only.
class ToolChangeSteps {
 public:
  ToolChangeSteps(const DeviceInForce& device, const MoveMaker& maker) : device_(device), maker_(maker) {}

  /// The step that puts the tool into the spindle, as far as the controller is concerned.
  [[nodiscard]] static MountTool mount(const Tool& tool);
  /// Spindles stop, and a person puts the tool in.
  [[nodiscard]] std::vector<QueueStep> by_hand(const Tool& tool) const;
  /// As `ToolChange` of device.json says. `old` is the number of the tool that comes out; `builder` is left where the
  /// steps leave the machine.
  [[nodiscard]] Expected<std::vector<QueueStep>> by_changer(int old, const Tool& tool, PathBuilder& builder) const;

 private:
  [[nodiscard]] Expected<QueueStep> make_step(const sdk::ToolChangeStep& step, int number, PathBuilder& builder) const;

  const DeviceInForce& device_;
  const MoveMaker& maker_;
};

}  // namespace rmac::gateway
