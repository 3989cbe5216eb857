#pragma once

#include "gateway/servo/servo_link.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_report.hpp"

namespace rmac::gateway {

/// One cycle of whatever mechanism is in force: takes over a new one, follows the plan, runs the servo loop, and
/// reports. Without a thread or a clock, so that a test can step it. Real-time safe; one thread.
class ServoCycle {
 public:
  ServoCycle(ServoLink& link, double period_s) noexcept : link_(link), period_s_(period_s), outputs_(link.marks) {}

  /// `missed`: deadlines that passed since the last call.
  void run(std::uint64_t missed) noexcept;
  /// What the last cycle left.
  [[nodiscard]] const ServoStatus& status() const noexcept { return status_; }
  /// How long the exchange with buses and I/O took in the last cycle.
  [[nodiscard]] std::int64_t exchange_ns() const noexcept { return report_.exchange_ns; }

 private:
  static constexpr std::int64_t kNever = -1;
  void serve_swap() noexcept;
  [[nodiscard]] SwapRequest::Result change_loops(SwapRequest& request) noexcept;
  void take_over(Mechanism* next) noexcept;
  void move(const ServoWishes& wishes) noexcept;
  /// A stop that the planner does not serve in time is the joints' own.
  void see_to_stop(const ServoWishes& wishes) noexcept;
  void fill_pose_set() noexcept;
  void publish(const ServoWishes& wishes) noexcept;

  ServoLink& link_;
  double period_s_;
  Mechanism* mechanism_ = nullptr;
  std::int64_t cycle_ = 0;
  std::int64_t stop_seen_ = kNever;  ///< cycle from which on a stop is wanted
  PathOutputs outputs_;
  ServoCommand command_;
  ServoReport report_;
  ServoStatus status_;
  CycleSample sample_;
};

}  // namespace rmac::gateway
