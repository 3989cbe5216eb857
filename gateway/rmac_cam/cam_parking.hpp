#pragma once

#include "gateway/rmac_cam/cam_forces.hpp"
#include "gateway/rmac_cam/cam_program_flow.hpp"
#include "gateway/rmac_cam/cam_spindles.hpp"
#include "gateway/rmac_cam/cam_tools.hpp"
#include "gateway/rmac_cam/settings/tool_place.hpp"
#include "rmac/sdk/cam/parking.hpp"

namespace rmac::gateway {

/// Sets a program aside with the settings that it ran at, and puts both in force again. Gateway thread only.
class CamParking final : public sdk::Parking {
 public:
  /// The parts of RMAC_CAM that a program leaves its mark in.
  struct Parts {
    CamPathSettings& path;
    CamJointSettings& joints;
    CamSpindles& spindles;
    CamTools& tools;
    CamForces& forces;
    CamProgramFlow& flow;
  };

  CamParking(const DeviceInForce& device, MotionSupervisor& supervisor, const ServoLink& link, Parts parts)
      : device_(device), supervisor_(supervisor), tool_(supervisor, link), parts_(parts) {}

  Expected<> park() override;
  Expected<> take_up() override;
  Expected<> drop() override;
  [[nodiscard]] std::optional<sdk::ParkedProgram> parked() const override;

 private:
  struct Settings {
    CamPathSettings::Values path;
    CamJointSettings::Values joints;
    std::vector<double> spindle_max_rpm;
  };

  /// Refuses to take the parked program up on what is loaded, or in the midst of a cycle.
  [[nodiscard]] Expected<> check_take_up(const gateway::Parking::Program& parked);
  [[nodiscard]] Expected<> queue_again(const gateway::Parking::Program& parked);
  [[nodiscard]] Expected<> queue_again(const StepAsSent& step);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  ToolPlace tool_;
  Parts parts_;
  Settings settings_;  ///< of the program that is parked, if there is one
};

}  // namespace rmac::gateway
