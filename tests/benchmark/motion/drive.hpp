#pragma once

#include <deque>
#include <functional>

#include "rmac/motion/follower/plan_follower.hpp"
#include "rmac/motion/path_builder.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac::bench {

/// A planner, and the servo loop's side of it, in lockstep: before each cycle the planner does all it can. Every plan
/// that passes from one to the other is seen here, so that what was really travelled can be checked.
class Drive {
 public:
  Drive(const PlannerModel& model, const std::vector<double>& start_joints);

  [[nodiscard]] Expected<> queue(const Move& move);
  /// One servo cycle, the planner having worked before it.
  const Setpoint& cycle();
  /// The planner does all that it can now, which is what a cycle begins with; the CPU time up to its first plan, s.
  double plan();
  /// The plan that is followed ends as the last command to stop asks.
  [[nodiscard]] bool stops() const;
  /// Cycles until the machine rests and nothing is left to plan; false when it has not after `most` cycles.
  bool run(std::int64_t most = 50'000'000);
  [[nodiscard]] bool resting();
  [[nodiscard]] std::int64_t now() const noexcept { return cycle_; }
  [[nodiscard]] const Setpoint& setpoint() const noexcept { return setpoint_; }
  /// The plan that is followed, or null.
  [[nodiscard]] const std::shared_ptr<const Plan>& plan_followed() const noexcept { return active_; }
  /// CPU time that the planner took, s.
  [[nodiscard]] double planning_s() const noexcept { return planning_s_; }
  /// CPU time of its longest step, s.
  [[nodiscard]] double longest_step_s() const noexcept { return longest_step_s_; }
  [[nodiscard]] std::uint64_t plans() const noexcept { return plans_; }

  /// Called with each stretch of a plan once it was travelled: the plan's times from and to.
  std::function<void(const Plan&, double, double)> on_travelled;
  /// Called with each setpoint.
  std::function<void(const Setpoint&)> on_setpoint;
  /// Tells `on_travelled` about the plan that is followed at the end.
  void finish();

  PathBuilder builder;

 private:
  PlanChannel to_tap_;
  PlanChannel to_follower_;

 public:
  Planner planner;

 private:
  [[nodiscard]] ServoProgress progress() const;
  void plan_once();
  void pass_plans();
  void travelled(std::int64_t until_cycle);

  PlanFollower follower_;
  Setpoint setpoint_;
  double period_s_;
  std::int64_t cycle_ = 0;
  std::deque<std::shared_ptr<const Plan>> passed_;  ///< copies: the planner frees its own
  std::shared_ptr<const Plan> active_;
  std::int64_t active_since_ = 0;
  double planning_s_ = 0, longest_step_s_ = 0;
  std::uint64_t plans_ = 0;
};

/// CPU time of this thread that work takes, s: what other programs on the machine take does not count, nor what it
/// costs to read the clock, which in a virtual machine is most of a microsecond.
class CpuTime {
 public:
  CpuTime();
  [[nodiscard]] double since_s() const;

 private:
  double began_s_;
};

}  // namespace rmac::bench
