#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/plan.hpp"
#include "rmac/motion/servo/setpoint.hpp"

namespace rmac::bench {

/// Largest demand on a machine, as parts of its limits; 1 is just at the limit.
struct Peaks {
  double speed = 0, acceleration = 0, jerk = 0;
  double feed = 0;  ///< of the programmed feed times the override
  [[nodiscard]] double worst() const { return std::max(std::max(speed, acceleration), jerk); }
};

/// Checks what was travelled, between cycles too: rebuilds the law of every stretch with closed forms of its own in
/// extended precision, takes 16 samples of the joints in each of its pieces (both ends included, from inside), and
/// differences them. Uses positions alone, never a derivative that the planner computed; shares no code with the
/// planner's own check.
class LimitCheck {
 public:
  explicit LimitCheck(std::vector<JointLimits> joints, double largest_feed_mm_s = 1e300)
      : joints_(std::move(joints)), largest_feed_(largest_feed_mm_s) {}

  /// The plan's times from and to; `override_factor` scales the programmed feed.
  void travelled(const Plan& plan, double from_s, double to_s, double override_factor = 1);
  /// One cycle's setpoint, in order: third differences at the machine's own rate, over a period of 1 ms.
  void setpoint(const Setpoint& setpoint);

  [[nodiscard]] const Peaks& between_cycles() const { return fine_; }
  [[nodiscard]] const Peaks& at_cycles() const { return coarse_; }
  /// The larger of both, of any joint limit.
  [[nodiscard]] double worst() const { return std::max(fine_.worst(), coarse_.worst()); }
  /// Time within the plan, length and joint of the largest jerk between cycles, for a person who looks for its cause.
  double jerk_at_t = 0, jerk_at_s = 0;
  std::size_t jerk_joint = 0;
  std::uint64_t jerk_plan = 0;

 private:
  void joints_at(const Plan& plan, std::size_t segment, long double s, double* joints) const;
  std::vector<JointLimits> joints_;
  double largest_feed_;
  Peaks fine_, coarse_;
  std::vector<std::array<double, kMaxJoints>> last_;
};

}  // namespace rmac::bench
