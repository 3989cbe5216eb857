#pragma once

#include <chrono>

#include "canopen/watch/recent.hpp"

namespace rmac::fieldbus::canopen {

/// How evenly the answers of a node come: how far the time between two of them is from the cycle, by the kernel's
/// stamps, which no delay of this program touches. Where an answer was missed nothing is measured. One thread measures,
/// others read.
class AnswerJitter {
 public:
  explicit AnswerJitter(std::chrono::nanoseconds period) noexcept : period_(period) {}

  void take(std::chrono::nanoseconds stamp) noexcept {
    const std::chrono::nanoseconds apart = stamp - last_;
    const bool any = last_.count() != 0 && stamp.count() != 0;
    last_ = stamp;
    // Nearer to one cycle than to none or to two.
    if (!any || apart < period_ / 2 || apart > period_ * 3 / 2) return;
    const auto off = static_cast<std::uint64_t>(std::chrono::abs(apart - period_).count());
    count_.add();
    sum_ns_.add(off);
    most_ns_.raise_to(off);
  }
  void forget() noexcept {
    last_ = {};
    count_.set(0);
    sum_ns_.set(0);
    most_ns_.set(0);
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.get(); }
  [[nodiscard]] double mean_s() const noexcept {
    const std::uint64_t count = count_.get();
    return count == 0 ? 0 : static_cast<double>(sum_ns_.get()) / static_cast<double>(count) * 1e-9;
  }
  [[nodiscard]] double most_s() const noexcept { return static_cast<double>(most_ns_.get()) * 1e-9; }

 private:
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds last_{0};  ///< of whoever measures alone
  Tally count_, sum_ns_, most_ns_;
};

}  // namespace rmac::fieldbus::canopen
