#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rmac/motion/plan_channel.hpp"
#include "rmac/motion/servo/setpoint.hpp"

namespace rmac {

/// Follows published plans, cycle by cycle, on the servo thread. Real-time safe.
class PlanFollower {
 public:
  PlanFollower(PlanChannel& channel, std::size_t joint_count, double period_s) noexcept;

  /// Sets the position held while there is no plan (joint_count values).
  void hold_at(std::span<const double> joints) noexcept;

  /// The setpoint of `cycle`; cycles come in order, without gaps. Takes over the newest plan that starts at or before
  /// it; a plan that came too late (its start lies in the past) is given back unused and its id reported by
  /// `last_refused`.
  void sample(std::int64_t cycle, Setpoint& setpoint) noexcept;

  /// Id of the newest plan accepted, under way or about to be; 0 for none.
  [[nodiscard]] std::uint64_t accepted_plan() const noexcept { return accepted_; }
  [[nodiscard]] std::uint64_t last_refused() const noexcept { return last_refused_; }

 private:
  void receive(std::int64_t cycle) noexcept;
  void activate(const Plan* plan) noexcept;
  void retire(const Plan* plan) noexcept;
  void follow(double t, Setpoint& setpoint) noexcept;
  [[nodiscard]] std::uint32_t count_done(double s) noexcept;

  PlanChannel& channel_;
  const Plan* active_ = nullptr;
  const Plan* next_ = nullptr;
  std::size_t piece_ = 0;
  std::size_t segment_ = 0;
  std::size_t joint_count_;
  double period_s_;
  double counted_s_ = 0;  ///< path length up to which ended moves were reported, from `origin_mm_`
  double origin_mm_ = 0;  ///< of the active plan
  std::uint64_t accepted_ = 0;
  std::uint64_t last_refused_ = 0;
  Setpoint held_;
};

}  // namespace rmac
