#pragma once

#include <functional>

#include "gateway/rmac_cam/cam_forces.hpp"
#include "gateway/state/operator.hpp"
#include "rmac/sdk/cam/cycle_control.hpp"

namespace rmac::gateway {

/// Passes commands of the cycle on to the motion supervisor. Gateway thread only; the stops and `started` also while
/// another thread uses RMAC_CAM. What names no operator is the program's command.
class CamCycle final : public sdk::CycleControl, public OperatorPort {
 public:
  /// `reset` brings the machine back after a fault.
  CamCycle(const DeviceInForce& device, MotionSupervisor& supervisor, CamForces& forces,
           std::function<Expected<>()> reset)
      : device_(device), supervisor_(supervisor), forces_(forces), reset_(std::move(reset)) {}

  /// `fresh`: it is another mechanism, and the feed override starts anew.
  void mechanism_changed(bool fresh);

  Expected<> start(sdk::CycleMode mode) override;
  Expected<> stop() override;
  Expected<> hold() override { return hold(nullptr); }
  Expected<> hold(const OperatorRef& who) override;
  Expected<> resume() override { return resume(nullptr); }
  Expected<> resume(const OperatorRef& who) override;
  Expected<double> retrace(double distance_mm) override { return retrace(distance_mm, nullptr); }
  Expected<double> retrace(double distance_mm, const OperatorRef& who) override;
  Expected<> stop_now() override;
  Expected<> reset() override { return reset_(); }
  [[nodiscard]] bool started() const override;
  Expected<> set_feed_override(double percent) override { return set_feed_override(percent, nullptr); }
  Expected<> set_feed_override(double percent, const OperatorRef& who) override;
  void let_go() override { supervisor_.operating().let_go(); }

 private:
  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  CamForces& forces_;
  std::function<Expected<>()> reset_;
};

}  // namespace rmac::gateway
