#pragma once

#include <vector>

#include "servo/watch/deadline_watch.hpp"
#include "servo/watch/joint_watch.hpp"
#include "servo/watch/torque_watch.hpp"

namespace rmac {

/// Watches all joints under control, what their motors give, and whether cycles come in time. Real-time safe but for
/// its making.
class MotionWatch {
 public:
  /// `parts` must outlive it.
  explicit MotionWatch(const ServoLoopParts& parts)
      : torques_(parts.actuators), deadlines_(parts.max_cycles_lost, parts.period_s) {
    for (std::size_t j = 0; j < parts.joints.size(); ++j) joints_.emplace_back(parts.joints[j], j, parts.period_s);
  }
  [[nodiscard]] JointWatch& joint(std::size_t joint) noexcept { return joints_[joint]; }
  [[nodiscard]] TorqueWatch& torques() noexcept { return torques_; }
  [[nodiscard]] DeadlineWatch& deadlines() noexcept { return deadlines_; }

 private:
  std::vector<JointWatch> joints_;
  TorqueWatch torques_;
  DeadlineWatch deadlines_;
};

}  // namespace rmac
