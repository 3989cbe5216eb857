#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gateway/servo/clock.hpp"
#include "gateway/servo/planning.hpp"
#include "gateway/servo/real_time.hpp"
#include "gateway/servo/servo_cycle.hpp"

namespace rmac::gateway {

/// Runs servo cycles, in one of two paces (docs/real-time.md). Real: the clock says when, planning runs on a thread of
/// its own, and nothing on the servo thread waits for anybody. Virtual: cycles follow each other as fast as they are
/// computed, planning happens between two of them, and they wait for whoever reads the samples; when there is nothing
/// to do they keep real time. Stepped: no thread, and no time but the count of cycles; whoever calls `step` is both
/// threads at once.
class ServoThread {
 public:
  struct Options {
    double period_s = 0.001;
    bool virtual_time = false;
    bool stepped = false;
    bool real_time = false;   ///< ask for priority, locked memory and CPU
    bool degraded_ok = true;  ///< run without what was not granted
    RealTimeWish wish;
    std::shared_ptr<Clock> clock;  ///< null: the monotonic clock
  };

  ServoThread(Options options, ServoLink& link, Planning& planning);
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// The error says what real time lacks and how to grant it.
  [[nodiscard]] Expected<> start();
  void stop() noexcept;
  /// Stepped: all planning that can be done now, and one cycle.
  void step();
  /// What was not granted, when that is allowed.
  [[nodiscard]] const std::vector<std::string>& shortcomings() const noexcept { return shortcomings_; }

 private:
  void run_real(ServoCycle& cycle) noexcept;
  void run_timed(ServoCycle& cycle, std::uint64_t missed) noexcept;
  void run_virtual(ServoCycle& cycle);
  void plan();

  Options options_;
  ServoLink& link_;
  Planning& planning_;
  std::atomic<bool> stop_{false};
  std::vector<std::string> shortcomings_;
  std::optional<ServoCycle> stepped_;
  std::thread servo_;
  std::thread planner_;
};

}  // namespace rmac::gateway
