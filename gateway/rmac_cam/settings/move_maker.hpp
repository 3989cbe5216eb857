#pragma once

#include <cstdint>
#include <span>

#include "gateway/rmac_cam/settings/cam_joint_settings.hpp"
#include "gateway/rmac_cam/settings/cam_path_settings.hpp"
#include "gateway/rmac_cam/settings/device_in_force.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::gateway {

/// Makes moves of geometry and what is in force. Gateway thread only.
class MoveMaker {
 public:
  MoveMaker(const DeviceInForce& device, const CamPathSettings& path, const CamJointSettings& joints)
      : device_(device), path_(path), joints_(joints) {}

  /// At the feed, accelerations and tolerance in force.
  [[nodiscard]] Move path_move(std::int64_t id, const Geometry& geometry) const;
  /// All joints together from `from`, at the joint interpolation speed and the joints' accelerations.
  [[nodiscard]] Move joint_move(std::int64_t id, const JointTargetGeometry& target, std::span<const double> from) const;
  /// The controller's own way of the tool tip, straight to `target` (part frame) from where it stands: at the feed in
  /// force or, where there is none, as fast as joint moves are allowed to be.
  [[nodiscard]] Move straight_move(const ToolPose& target) const;
  /// A path move at a speed of its own, bounded as feeds are.
  [[nodiscard]] Expected<Move> path_move_at(const char* function, std::int64_t id, const Geometry& geometry,
                                            double speed_mm_s) const;
  /// Refuses a target that is not one position a joint, and a speed that is none.
  [[nodiscard]] Expected<> check_joint_target(const char* function, const JointTargetGeometry& target,
                                              double speed) const;
  /// All joints together from `from`, as `check_joint_target` let them through; `speed`, in mm/s or degrees/s, is that
  /// of the linear joints together, or of all where no linear one moves.
  [[nodiscard]] Expected<Move> joint_move_at(const char* function, std::int64_t id, const JointTargetGeometry& target,
                                             std::span<const double> from, double speed) const;

 private:
  /// How long the joints take, in s.
  [[nodiscard]] double duration_s(const JointTargetGeometry& target, std::span<const double> from, double speed) const;

  const DeviceInForce& device_;
  const CamPathSettings& path_;
  const CamJointSettings& joints_;
};

}  // namespace rmac::gateway
