#pragma once

#include <cstddef>

#include "rmac/motion/force_control.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/cycles_beyond.hpp"
#include "servo/watch/oscillation_watch.hpp"
#include "servo/watch/response_watch.hpp"

namespace rmac {

/// What the watch over a joint looks at in one cycle: mm or degrees and s, N or N·m.
struct JointSeen {
  double jump = 0;             ///< change of its position's step
  bool may_stop = false;       ///< which makes it no faster than it was a moment before
  bool answered = true;        ///< its drives did in this cycle
  double velocity = 0;         ///< measured
  double following_error = 0;  ///< of the cycle in which the drives were where they say
  double position_set = 0, velocity_set = 0;
  double force = 0;  ///< measured
  ContactState contact = ContactState::None;
  double searched = 0;       ///< way without contact
  bool force_hangs = false;  ///< it stays the same, however the joint is pushed
  bool bounces = false;      ///< off the part that it comes upon: it swings, and its loop does not
  OscillationSeen loop{};
};

/// Watches one joint under control. Real-time safe.
class JointWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  JointWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint),
        index_(static_cast<std::uint32_t>(index)),
        oscillation_(joint, index, period_s),
        response_(joint, index, period_s) {}

  void step(const JointSeen& seen, FaultSink& faults) noexcept;
  /// The joint is not under control; where its encoder puts it meanwhile.
  void rest(double position) noexcept {
    rest();
    response_.rest(position);
  }
  void rest() noexcept {
    too_fast_.restart();
    suspected_ = 0;
    steady_ = true;
    oscillation_.rest();
    response_.rest();
  }

 private:
  void watch_jump(const JointSeen& seen, FaultSink& faults) noexcept;
  void watch_sensor(FaultSink& faults) const noexcept;
  void watch_contact(const JointSeen& seen, FaultSink& faults) const noexcept;
  void raise(ServoFault::Kind kind, double value, double bound, FaultSink& faults) const noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  double suspected_ = 0;  ///< a jump in the last cycle that may have been a stop
  bool steady_ = true;    ///< there was none of half the bound
  CyclesBeyond too_fast_;
  OscillationWatch oscillation_;
  ResponseWatch response_;
};

}  // namespace rmac
