#pragma once

#include <fmt/format.h>

#include "gateway/state/operator.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// The share of the programmed feed at which the machine goes: a person's override, and while a jog by velocity lasts
/// that jog's share of its full speed.
class FeedOverride {
 public:
  /// `by` is the operator who sets it, or null. The 0 that an operator set holds the machine: it is not a program's to
  /// raise.
  [[nodiscard]] Expected<> set(double percent, const OperatorRef& by = {}) {
    if (kept_by_ && !by && percent != percent_) {
      return failure(MinorCode::Other,
                     fmt::format("SetFeedOverride: {}, who {} the operator, has set the override to 0, and only an "
                                 "operator raises it (operator.acquire; rmac override){}",
                                 kept_by_->name(), kept_by_->present() ? "is" : "was",
                                 kept_by_->present() ? "" : "; or take it over with Reset, for that one has left"));
    }
    percent_ = percent;
    if (by) kept_by_ = percent == 0 ? by : nullptr;
    return {};
  }
  /// As it was set, for people.
  [[nodiscard]] double percent() const noexcept { return percent_; }
  /// The operator who set it to 0; null: nobody did.
  [[nodiscard]] const OperatorRef& kept_by() const noexcept { return kept_by_; }
  /// It is the program's to raise.
  void let_go() noexcept { kept_by_ = nullptr; }
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
  OperatorRef kept_by_;
};

}  // namespace rmac::gateway
