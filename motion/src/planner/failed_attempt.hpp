#pragma once

#include <cstdint>

namespace rmac {

/// The last attempt that found no plan: the same is tried again only after some cycles, or from another state.
class FailedAttempt {
 public:
  void failed(std::int64_t cycle, std::uint64_t base_plan, bool from_rest) noexcept {
    cycle_ = cycle;
    base_plan_ = base_plan;
    from_rest_ = from_rest;
  }
  /// What failed was another wish.
  void forget() noexcept { cycle_ = -kRetryAfter; }
  /// Whether it is too early to try again. What found no plan in motion may find one from rest.
  [[nodiscard]] bool too_early(std::int64_t cycle, bool from_rest) const noexcept {
    return cycle < cycle_ + kRetryAfter && from_rest_ == from_rest;
  }
  /// Whether it was to follow this plan.
  [[nodiscard]] bool was_behind(std::uint64_t plan) const noexcept { return base_plan_ == plan; }

  static constexpr std::int64_t kRetryAfter = 10;

 private:
  std::int64_t cycle_ = -kRetryAfter;
  std::uint64_t base_plan_ = 0;
  bool from_rest_ = false;
};

}  // namespace rmac
