#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gateway/record/flight_record.hpp"
#include "gateway/record/flight_recorder_options.hpp"
#include "gateway/servo/cycle_history.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Writes what the servo thread left in the cycle history to files, on a thread of its own: the servo thread knows
/// nothing of it.
class FlightRecorder {
 public:
  /// Cycles that a history must hold so that none is overwritten before it is written down.
  [[nodiscard]] static std::size_t history_cycles(const FlightRecorderOptions& options, double period_s);

  FlightRecorder(FlightRecorderOptions options, double period_s, CycleHistory& history);
  /// Writes what was asked for, then ends.
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  // All below: gateway thread. None of it waits for a disk, but for `folder`'s.

  /// Has the cycles up to `head.cycle` written, and those of the stop that follows a fault; gives the record's name.
  /// Refused while as many as can be kept in mind are still to be written.
  [[nodiscard]] Expected<std::string> request(FlightHead head);

  /// What became of a request.
  struct Outcome {
    FlightHead head;
    Expected<> written;
  };
  [[nodiscard]] std::vector<Outcome> take_outcomes();
  [[nodiscard]] const FlightFolder& folder() const noexcept { return folder_; }

 private:
  struct Request {
    FlightHead head;
    std::int64_t first = 0, last = 0;  ///< cycles that it is about
    bool copied = false;
  };
  void run();
  [[nodiscard]] Expected<> write(Request& request);
  void wait_for_cycle(std::int64_t cycle);
  [[nodiscard]] std::vector<CycleSample> samples_of(const Request& request) const;
  /// With the lock held.
  void want_what_is_left();

  FlightRecorderOptions options_;
  double period_s_;
  CycleHistory& history_;
  FlightFolder folder_;
  std::chrono::system_clock::time_point last_named_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  std::deque<Request> requests_;  ///< the first is being written
  std::vector<Outcome> outcomes_;
  std::thread thread_;
};

}  // namespace rmac::gateway
