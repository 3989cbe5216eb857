#pragma once

#include <cstdint>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// What it looks at in one cycle: N and mm, or N·m and degrees.
struct ResponseSeen {
  double effort = 0;          ///< that acted over the last way
  double position = 0;        ///< measured
  double position_set = 0;    ///< of the cycle that the position belongs to
  bool out_of_bound = false;  ///< the following error is
};

/// Finds a joint that does not answer: it goes faster and faster against its effort and away from its setpoint, the
/// faster the longer that lasts, as with a motor or an encoder of the wrong sign, where what pushes it grows with the
/// way, and what only pushed a sound one is held better and better; or it stands still while it is to move, as with an
/// encoder that froze. Real-time safe.
class ResponseWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  ResponseWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint), index_(static_cast<std::uint32_t>(index)), period_s_(period_s) {}

  void step(const ResponseSeen& seen, FaultSink& faults) noexcept;
  /// The joint is not under control.
  void rest() noexcept;

 private:
  void forget_direction(double error) noexcept;
  void watch_direction(const ResponseSeen& seen, double way, FaultSink& faults) noexcept;
  void watch_standing(const ResponseSeen& seen, FaultSink& faults) noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;

  bool begun_ = false;
  double last_position_ = 0, last_way_ = 0;
  int against_ = 0;                        ///< cycles on end
  double gone_ = 0;                        ///< way of them
  double first_gain_ = 0, last_gain_ = 0;  ///< of its way, in the first half of them and after it
  double error_before_ = 0;
  double stood_at_ = 0;  ///< where it stands, and was to stand when that began
  double wanted_at_ = 0;
  std::int64_t stands_ = 0;  ///< cycles
};

}  // namespace rmac
