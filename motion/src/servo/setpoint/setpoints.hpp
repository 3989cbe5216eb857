#pragma once

#include <array>
#include <span>
#include <vector>

#include "rmac/motion/follower/joint_brake.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/setpoint.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/learned/learned_offsets.hpp"
#include "servo/setpoint/force_loop.hpp"
#include "servo/setpoint/recent_way.hpp"
#include "servo/setpoint/velocity_follower.hpp"

namespace rmac {

/// Where each joint is wanted in a cycle: on the plan, where its force sends it, where the plan's velocity takes it, on
/// the way of a stop, or where it is held. mm or degrees and s. Real-time safe but for its making.
class Setpoints {
 public:
  /// What there is to follow in one cycle, and what the joints do.
  struct Seen {
    const Setpoint& plan;  ///< of the kinematic joints
    std::span<const double> wanted_force;
    std::span<const double> position;  ///< measured, as the next two
    std::span<const double> velocity;
    std::span<const double> force;
    std::span<const double> effort;  ///< of the cycle before
    IndexSet live;                   ///< joints under control
    bool follows = false;            ///< the plan, and the wanted forces, count
  };

  /// `parts` must outlive it. `delays`: so many cycles before this one was a joint where it tells in it. The drives of
  /// some joints `follow_themselves`.
  Setpoints(const ServoLoopParts& parts, const Wiring::Delays& delays, IndexSet follow_themselves);

  /// One cycle. Where the plan has no number for a joint, that is a fault, and this joint and those after it are wanted
  /// where they were.
  void step(const Seen& seen, FaultSink& faults) noexcept;
  /// One cycle of a stop that keeps power: each joint by itself, within its limits. What is pushed against a part lets
  /// go of it. `seen.plan` does not count.
  void brake(const Seen& seen) noexcept;

  /// Before all else of a cycle: so far no setpoint has gone anywhere in it.
  void begin_cycle() noexcept;
  /// The joint is wanted at rest there.
  void hold_at(std::size_t joint, double position) noexcept;
  /// All joints are held there; nothing else changes.
  void hold_at(std::span<const double> positions) noexcept;
  /// The joint's drive is out of reach, and stops it by its own watch over the appliance.
  void give_up(std::size_t joint) noexcept;
  /// No joint is under control.
  void let_go() noexcept;
  void begin_braking() noexcept;
  [[nodiscard]] bool braked() const noexcept;

  [[nodiscard]] std::span<const double> positions() const noexcept { return {position_.data(), joints_.size()}; }
  [[nodiscard]] const std::array<double, kMaxJoints>& position() const noexcept { return position_; }
  [[nodiscard]] const std::array<double, kMaxJoints>& velocity() const noexcept { return velocity_; }
  [[nodiscard]] const std::array<double, kMaxJoints>& acceleration() const noexcept { return acceleration_; }
  /// How far the setpoint of a joint has gone on since the joint was where it tells in this cycle.
  [[nodiscard]] double gone_on(std::size_t joint) const noexcept { return ways_[joint].position.length(); }
  [[nodiscard]] double velocity_gone_on(std::size_t joint) const noexcept { return ways_[joint].velocity.length(); }
  /// Where a joint was wanted when it was where it tells in this cycle, minus that.
  [[nodiscard]] double following_error(std::size_t joint, double measured) const noexcept {
    return position_[joint] - gone_on(joint) - measured;
  }
  [[nodiscard]] double slip(std::size_t joint) const noexcept { return followers_[joint].slip(); }
  /// What is added for the laws alone.
  [[nodiscard]] LearnedOffsets& learned() noexcept { return learned_; }
  [[nodiscard]] const LearnedOffsets& learned() const noexcept { return learned_; }
  [[nodiscard]] const ForceLoop& force_loop(std::size_t joint) const noexcept { return force_loops_[joint]; }
  /// A joint of which the force is kept by an effort beside its law's.
  [[nodiscard]] bool pushes(std::size_t joint) const noexcept { return force_loops_[joint].pushes(); }

 private:
  void choose(const Seen& seen, FaultSink& faults) noexcept;
  [[nodiscard]] bool follow(std::size_t joint, const Seen& seen, bool followed_before, FaultSink& faults) noexcept;
  [[nodiscard]] bool by_force(std::size_t joint, IndexSet live) const noexcept {
    return joints_[joint].method == ControlMethod::Force && has(live, joint);
  }
  void follow_force(std::size_t joint, const Seen& seen) noexcept;
  void set(std::size_t joint, const JointSetpoint& wanted) noexcept;

  std::span<const ServoJoint> joints_;
  std::size_t kinematic_joints_;
  double period_s_;
  bool virtual_mode_;
  std::array<double, kMaxJoints> position_{}, velocity_{}, acceleration_{};
  /// Of a joint's setpoint, as long ago as the joint's answers are.
  struct Way {
    RecentWay position, velocity;

    void begin_cycle() noexcept { position.begin_cycle(), velocity.begin_cycle(); }
    void forget() noexcept { position.forget(), velocity.forget(); }
  };
  /// It was there before this cycle.
  void note_way(std::size_t joint, double position_before, double velocity_before) noexcept;
  std::vector<Way> ways_;
  IndexSet on_the_way_ = 0;  ///< joints that followed the plan in the cycle before
  std::vector<VelocityFollower> followers_;
  std::vector<ForceLoop> force_loops_;
  LearnedOffsets learned_;
  JointBrake brake_;
  Setpoint braking_;  ///< of all joints; its positions, velocities and accelerations alone
  double braked_s_ = 0;
};

}  // namespace rmac
