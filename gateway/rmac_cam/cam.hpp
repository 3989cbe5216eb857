#pragma once

#include <functional>

#include "gateway/animation/machine_shape.hpp"
#include "gateway/rmac_cam/cam_cmm_moves.hpp"
#include "gateway/rmac_cam/cam_cycle.hpp"
#include "gateway/rmac_cam/cam_forces.hpp"
#include "gateway/rmac_cam/cam_guard.hpp"
#include "gateway/rmac_cam/cam_parking.hpp"
#include "gateway/rmac_cam/cam_positioning.hpp"
#include "gateway/rmac_cam/cam_program_flow.hpp"
#include "gateway/rmac_cam/cam_queue.hpp"
#include "gateway/rmac_cam/cam_spindles.hpp"
#include "gateway/rmac_cam/cam_tools.hpp"
#include "gateway/rmac_cam/settings/cam_frame_settings.hpp"
#include "rmac/sdk/rmac_cam.hpp"

namespace rmac::gateway {

/// RMAC_CAM (dissertation 4.5) on top of the motion supervisor: wires its parts, each of which keeps what it is about,
/// in the wire's units, and bounds it by the mechanism. Gateway thread only, but for what the parts except.
class Cam final : public sdk::RmacCam {
 public:
  /// `reset` brings the machine back after a fault.
  Cam(MotionSupervisor& supervisor, ServoLink& link, ToolRack& rack, std::function<Expected<>()> reset);

  /// Tells each part of the mechanism that is in force now, or that there is none. `fresh`: it is another one, so
  /// everything starts anew; otherwise the same one is configured anew.
  void mechanism_changed(const sdk::DeviceObject* device, bool fresh);

  CamCycle& cycle() override { return cycle_; }
  CamQueue& queue() override { return queue_; }
  CamCmmMoves& cmm_moves() override { return cmm_moves_; }
  CamPathSettings& path() override { return path_; }
  CamJointSettings& joints() override { return joints_; }
  CamFrameSettings& frames() override { return frames_; }
  CamSpindles& spindles() override { return spindles_; }
  CamPositioning& positioning() override { return positioning_; }
  CamParking& parking() override { return parking_; }
  CamForces& forces() override { return forces_; }
  CamProgramFlow& flow() override { return flow_; }
  CamTools& tools() { return tools_; }
  CamGuard& guard() { return guard_; }
  MachineShape& shape() { return shape_; }

  /// What the measuring part of RMAC_CAM is made of.
  [[nodiscard]] const DeviceInForce& device() const { return device_; }
  [[nodiscard]] const MoveMaker& move_maker() const { return maker_; }

 private:
  MotionSupervisor& supervisor_;
  ServoLink& link_;
  DeviceInForce device_;
  CamPathSettings path_;
  CamJointSettings joints_;
  MoveMaker maker_;
  CamFrameSettings frames_;
  CamForces forces_;
  CamTools tools_;
  CamSpindles spindles_;
  CamCycle cycle_;
  CamQueue queue_;
  CamCmmMoves cmm_moves_;
  CamPositioning positioning_;
  CamProgramFlow flow_;
  CamParking parking_;
  MachineShape shape_;
  CamGuard guard_;
};

}  // namespace rmac::gateway
