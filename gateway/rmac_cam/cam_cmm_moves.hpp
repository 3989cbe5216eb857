#pragma once

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/settings/move_maker.hpp"
#include "rmac/sdk/cam/cmm_moves.hpp"

namespace rmac::gateway {

/// Takes the moves of a measuring program, each with a speed of its own. Gateway thread only.
class CamCmmMoves final : public sdk::CmmMoves {
 public:
  CamCmmMoves(const DeviceInForce& device, MotionSupervisor& supervisor, const MoveMaker& maker)
      : device_(device), supervisor_(supervisor), maker_(maker) {}

  Expected<> to_point(std::int64_t id, const Vector& point, double speed) override;
  Expected<> in_arc(std::int64_t id, const sdk::ArcTo& arc, double speed) override;
  Expected<> all_joints(std::int64_t id, std::vector<double> joints, double speed) override;
  Expected<> rotary_joint(std::int64_t id, int joint, double position, int direction, double speed) override;

 private:
  [[nodiscard]] Expected<> add_path_move(const char* function, std::int64_t id, const Geometry& geometry, double speed);
  [[nodiscard]] Expected<> add_joint_move(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                          double speed);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const MoveMaker& maker_;
};

}  // namespace rmac::gateway
