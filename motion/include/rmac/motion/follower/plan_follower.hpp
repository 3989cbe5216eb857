#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rmac/motion/follower/horizon.hpp"
#include "rmac/motion/follower/joint_brake.hpp"
#include "rmac/motion/follower/path_departure.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/plan_channel.hpp"
#include "rmac/motion/servo/setpoint.hpp"

namespace rmac {

class PathSegment;
struct PathState;

/// Follows published plans, cycle by cycle, on the servo thread. Real-time safe, once built.
///
/// It leaves the path when it is told to (`leave`), and by itself where the kinematics no longer tell where the path
/// goes on: no solution, no number, or joints that no acceleration within their limits could bring there. Then every
/// joint brakes by itself, from the last setpoint, and rests. Only a plan that was made after the planner had learnt of
/// it (`PathDeparture`) moves the joints again.
class PlanFollower {
 public:
  PlanFollower(PlanChannel& channel, std::span<const JointLimits> joints, double period_s);

  /// Sets the position held while there is no plan (a value for each joint).
  void hold_at(std::span<const double> joints) noexcept;

  /// The setpoint of `cycle`; cycles come in order, without gaps. Takes over the newest plan that starts at or before
  /// it; a plan that came too late (its start lies in the past) is given back unused and its id reported by
  /// `last_refused`.
  void sample(std::int64_t cycle, Setpoint& setpoint) noexcept;

  /// The path is not to be followed any further, from the next sample on, unless a plan made to stop is under way then.
  /// Without effect at rest.
  void leave() noexcept { leaves_ = true; }
  /// The setpoints are not the path's: joints brake, or rest after that.
  [[nodiscard]] bool off_path() const noexcept { return off_path_; }
  /// When, and why, it left the path last.
  [[nodiscard]] const PathDeparture& departure() const noexcept { return departure_; }

  /// How far ahead of the last sample motion is planned: by the newest plan accepted, or off the path by the brake.
  [[nodiscard]] const Horizon& horizon() const noexcept { return horizon_.now(); }

  /// Id of the newest plan accepted, under way or about to be; 0 for none.
  [[nodiscard]] std::uint64_t accepted_plan() const noexcept { return accepted_; }
  [[nodiscard]] std::uint64_t last_refused() const noexcept { return last_refused_; }

 private:
  void receive(std::int64_t cycle) noexcept;
  [[nodiscard]] bool stops() const noexcept;
  void activate(const Plan* plan) noexcept;
  void retire(const Plan* plan) noexcept;
  [[nodiscard]] Horizon planned() const noexcept;
  void follow(std::int64_t cycle, Setpoint& setpoint) noexcept;
  /// False where the kinematics tell no such place.
  [[nodiscard]] bool place(const PathSegment& segment, double s, const PathState& at, Setpoint& setpoint) noexcept;
  void depart(PathDeparture::Cause cause, std::size_t joint) noexcept;
  void brake(std::int64_t cycle, Setpoint& setpoint) noexcept;
  [[nodiscard]] std::uint32_t count_done(double s) noexcept;

  PlanChannel& channel_;
  std::vector<JointLimits> joints_;
  JointBrake brake_;
  double period_s_;
  const Plan* active_ = nullptr;  ///< stays after a departure, until the planner has learnt of it
  const Plan* next_ = nullptr;
  std::size_t piece_ = 0;
  std::size_t segment_ = 0;
  double rests_s_ = 0;    ///< path length at which the active plan ends at rest
  double counted_s_ = 0;  ///< path length up to which ended moves were reported, from `origin_mm_`
  double origin_mm_ = 0;  ///< of the active plan
  std::uint64_t accepted_ = 0;
  std::uint64_t last_refused_ = 0;
  std::int64_t cycle_ = 0;  ///< of the last sample
  Setpoint last_;
  bool placed_ = true;  ///< `last_` is where the joints were put, not where a plan led them
  bool leaves_ = false;
  bool off_path_ = false;
  PathDeparture departure_;
  HorizonWatch horizon_;
};

}  // namespace rmac
