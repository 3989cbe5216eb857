#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/gantry.hpp"
#include "rmac/motion/servo/servo_handover.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/encoder_digits.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/laws/effort_filter.hpp"
#include "servo/watch/cycles_beyond.hpp"
#include "servo/watch/oscillation_watch.hpp"

namespace rmac {

/// Motors that move one joint side by side. The joint's law knows their mean alone; here each is told apart: how far it
/// is from where all of them have the joint, and what brings it back there.
///
/// How they stand when their joint first comes under control is how they belong, and stays so until they look for home
/// or lose their reference. Real-time safe but for its making.
class Gantries {
 public:
  /// Both must outlive it.
  Gantries(const ServoLoopParts& parts, const Wiring& wiring);

  /// No joint has motors side by side.
  [[nodiscard]] bool empty() const noexcept { return joints_.empty(); }
  /// One cycle: where the shafts are, and how fast they turn.
  void read(std::span<const double> shafts, std::span<const double> rad_s) noexcept;
  /// Nobody knows any more how these motors belong.
  void forget(IndexSet actuators) noexcept;
  /// The joint comes under control. What is amiss then is brought back by and by.
  void engage(std::size_t joint) noexcept;
  /// The joint was under control by another loop, which `take_over` told of.
  void go_on(std::size_t joint) noexcept;
  struct Seen {
    double position = 0;                  ///< of the joint
    double wanted = 0, wanted_speed = 0;  ///< where and how fast it is to be
    double wanted_acceleration = 0;
    double effort = 0;      ///< that its law gave it
    int answer_delay = 0;   ///< its position is that of so many cycles before
    bool answered = false;  ///< its drives did, in this cycle
  };
  /// One cycle of a joint under control.
  void watch(std::size_t joint, const Seen& seen, FaultSink& faults) noexcept;
  /// From shaft angles that have the motors in step to those that have them as they belong.
  void place(std::span<double> aims) const noexcept;
  /// One cycle of a joint under control, to which its law gives this effort: finds the torques. Behind `watch`.
  void hold(std::size_t joint, double effort) noexcept;

  /// At the shafts, beside what the joints' laws give them.
  [[nodiscard]] const std::array<double, kMaxJoints>& torques_nm() const noexcept { return torque_; }
  /// How far it is ahead of its joint: mm or degrees of the joint; 0 of a motor that moves its joint alone.
  [[nodiscard]] const std::array<double, kMaxJoints>& ahead() const noexcept { return ahead_; }
  /// How it belongs among those beside it; none where that is not known.
  [[nodiscard]] std::optional<ServoHandover::Beside> beside(std::size_t actuator) const noexcept;
  void take_over(std::size_t actuator, const ServoHandover::Beside& beside) noexcept;

 private:
  struct Motor {
    std::size_t actuator;
    int direction;           ///< of its drive
    double per_rad_at_home;  ///< of the joint
    double late_s;           ///< by which its drive tells later than the soonest of them
    double at_zero_counts;   ///< rad that it is apart from where its joint is where all counters stand at 0
    EffortFilter filter;
    EncoderDigits digits;
    std::optional<double> belongs{};  ///< rad that it is apart
    double way = 0;                   ///< that its shaft tells alone, from where it is 0
    double apart = 0;                 ///< rad, from where its joint has it
    double per_rad = 0;               ///< of the joint, where it stands
    double left = 0;                  ///< of what was amiss as power came, mm or degrees
    double before = 0, rate = 0;      ///< ahead in the cycle before; by how much more a second
    double held = 0;                  ///< effort that brings it back
    double still_since = 0;           ///< where its joint was when its digits began to stay
  };
  struct Joint {
    std::size_t joint;
    Gantry given;
    double power_a_speed;  ///< of its motors, W, at an effort and a speed of 1
    OscillationWatch oscillation;
    std::vector<Motor> motors;
    bool begins = false;  ///< it came under control in this cycle
    double allowed = 0;   ///< skew
    CyclesBeyond beyond{};
  };

  [[nodiscard]] Joint* of(std::size_t joint) noexcept;
  [[nodiscard]] const Motor* motor(std::size_t actuator) const noexcept;
  [[nodiscard]] double skew(const Joint& joint) const noexcept;
  void note_digits(Motor& motor, const Joint& joint, const Seen& seen) const noexcept;
  /// Whether its digits stay while the joint goes on by the others.
  [[nodiscard]] bool froze(const Motor& motor, const Joint& joint) const noexcept;
  void watch_skew(Joint& joint, const Seen& seen, FaultSink& faults) noexcept;
  void start(Joint& joint, bool amiss) noexcept;

  const ServoLoopParts& parts_;
  double period_s_;
  std::vector<Joint> joints_;
  std::array<double, kMaxJoints> at_{};  ///< joints, as all their motors have them
  std::array<double, kMaxJoints> ahead_{}, torque_{};
};

/// Refuses a `Gantry` that has nothing to hold together, or cannot.
[[nodiscard]] Expected<> check_gantries(const ServoLoopParts& parts, const Wiring& wiring);

}  // namespace rmac
