#pragma once

#include <cstdint>

namespace rmac {

/// The last attempt that found no plan. The same is tried again only some cycles later; what found no plan in motion
/// may find one from rest sooner.
class FailedAttempt {
 public:
  static constexpr std::int64_t kRetryAfter = 10;

  /// An attempt failed in `cycle`. `base_plan`: the plan that it was to continue, 0 when there was none.
  void record(std::int64_t cycle, std::uint64_t base_plan, bool from_rest,
              std::int64_t retry_after = kRetryAfter) noexcept {
    next_cycle_ = cycle + retry_after;
    base_plan_ = base_plan;
    from_rest_ = from_rest;
  }
  /// What is wanted now is not what failed: it may be tried at once.
  void forget() noexcept { next_cycle_ = 0; }
  [[nodiscard]] bool too_early(std::int64_t cycle, bool from_rest) const noexcept {
    return cycle < next_cycle_ && from_rest == from_rest_;
  }
  /// Whether it was to continue this plan; known even once it is forgotten.
  [[nodiscard]] bool was_based_on(std::uint64_t plan) const noexcept { return plan == base_plan_; }

 private:
  std::int64_t next_cycle_ = 0;
  std::uint64_t base_plan_ = 0;
  bool from_rest_ = false;
};

}  // namespace rmac
