#pragma once

#include <signal.h>

#include <chrono>
#include <functional>
#include <stop_token>
#include <thread>

namespace rmac::gateway {

/// SIGTERM, SIGINT and SIGHUP: blocked in every thread, so that they interrupt no cycle and however many come, none
/// turns an orderly end into a kill; a thread of its own waits for them, so that they count even where all others hang.
class EndSignals {
 public:
  using Told = std::function<void(const char* signal)>;

  /// Blocks them in the calling thread and in all that it will start, for good, and ignores SIGPIPE.
  static void block() noexcept;

  /// `told` is called on the first one, with its name, on a thread of this object. Where the process still runs
  /// `patience` after it, `give_up` is called there. They must have been blocked before.
  EndSignals(Told told, std::chrono::milliseconds patience, std::function<void()> give_up);
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;
  ~EndSignals() = default;

 private:
  void wait(const std::stop_token& stop) const;

  Told told_;
  std::chrono::milliseconds patience_;
  std::function<void()> give_up_;
  std::jthread thread_;
};

}  // namespace rmac::gateway
