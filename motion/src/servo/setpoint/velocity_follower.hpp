#pragma once

#include "rmac/motion/servo/servo_loop_parts.hpp"

namespace rmac {

/// Where a joint is wanted, and how fast: mm or degrees and s.
struct JointSetpoint {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

/// The setpoint of a joint under velocity control, which goes as fast as the plan says and does not make good what
/// keeps it from that: it goes no further ahead than it may be behind, and turns back from there at once. As long as
/// nothing keeps it, the joint is where the plan has it. Real-time safe.
class VelocityFollower {
 public:
  /// `joint` must outlive it; its control method plays no part. It is told where the joint was `delay` cycles before.
  VelocityFollower(const ServoJoint& joint, double period_s, int delay = 0) noexcept
      : joint_(&joint), period_s_(period_s), late_s_(delay * period_s) {}

  /// From now on on the plan, from where the joint is held.
  void begin(double held, double planned) noexcept { slip_ = held - planned; }
  /// The joint is where the plan has it.
  void on_plan() noexcept { slip_ = 0; }
  /// One cycle: where the joint is wanted, for what the plan has, where it was wanted and where it is.
  [[nodiscard]] JointSetpoint step(const JointSetpoint& planned, double held, double measured) noexcept;
  /// How far the setpoint is off the plan.
  [[nodiscard]] double slip() const noexcept { return slip_; }

 private:
  const ServoJoint* joint_;
  double period_s_, late_s_;
  double slip_ = 0;
};

}  // namespace rmac
