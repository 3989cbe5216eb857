#pragma once

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/settings/device_in_force.hpp"
#include "rmac/sdk/cam/frame_settings.hpp"

namespace rmac::gateway {

/// Sets part and tool interface frame at rest. They are kept by the motion supervisor, whose servo cycles go by them.
/// Gateway thread only.
class CamFrameSettings final : public sdk::FrameSettings {
 public:
  CamFrameSettings(const DeviceInForce& device, MotionSupervisor& supervisor)
      : device_(device), supervisor_(supervisor) {}

  Expected<> set_part(const Frame& frame) override;
  [[nodiscard]] Frame part() const override;
  Expected<> set_tool_interface(const Frame& frame) override;
  [[nodiscard]] Frame tool_interface() const override;

 private:
  [[nodiscard]] Expected<> set(const char* function, const Frames& frames);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
};

}  // namespace rmac::gateway
