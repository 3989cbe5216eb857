#pragma once

namespace rmac::gateway {

/// The share of the programmed feed at which the machine goes: a person's override, and while a jog by velocity lasts
/// that jog's share of its full speed.
class FeedOverride {
 public:
  void set(double percent) noexcept { percent_ = percent; }
  /// As it was set, for people.
  [[nodiscard]] double percent() const noexcept { return percent_; }
  void jog_at(double share) noexcept { jog_share_ = share; }
  /// True when a jog at less than its full speed has ended with this.
  bool end_jog() noexcept {
    const bool slowed = jog_share_ != 1;
    jog_share_ = 1;
    return slowed;
  }
  /// What the planner is to make of it.
  [[nodiscard]] double effective_percent() const noexcept { return percent_ * jog_share_; }

 private:
  double percent_ = 100;
  double jog_share_ = 1;
};

}  // namespace rmac::gateway
