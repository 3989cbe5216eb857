#pragma once

#include "gateway/rmac_cam/cam_tools.hpp"
#include "rmac/sdk/cam/move_queue.hpp"

namespace rmac::gateway {

/// Takes moves of a program: at the feed in force, with the tool that is to be in the spindle then. Gateway thread
/// only; `moves_left` also while another thread uses RMAC_CAM.
class CamQueue final : public sdk::MoveQueue {
 public:
  CamQueue(const DeviceInForce& device, MotionSupervisor& supervisor, const CamPathSettings& path,
           const MoveMaker& maker, const CamTools& tools)
      : device_(device), supervisor_(supervisor), path_(path), maker_(maker), tools_(tools) {}

  Expected<> add(std::int64_t id, const Geometry& geometry) override;
  [[nodiscard]] int moves_left() const override { return static_cast<int>(supervisor_.moves_left()); }
  [[nodiscard]] Expected<std::vector<double>> joints_at(const ToolPose& pose) const override;

 private:
  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const CamPathSettings& path_;
  const MoveMaker& maker_;
  const CamTools& tools_;
};

}  // namespace rmac::gateway
