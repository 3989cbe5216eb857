#pragma once

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/settings/device_in_force.hpp"
#include "rmac/sdk/cam/joint_forces.hpp"

namespace rmac::gateway {

/// Asks for forces of joints under force control. Gateway thread only; `let_go` also while another thread uses
/// RMAC_CAM.
class CamForces final : public sdk::JointForces {
 public:
  CamForces(const DeviceInForce& device, MotionSupervisor& supervisor) : device_(device), supervisor_(supervisor) {}

  Expected<> set(int joint, double force) override;
  /// Joints under force control hold their positions.
  void let_go();

 private:
  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
};

}  // namespace rmac::gateway
