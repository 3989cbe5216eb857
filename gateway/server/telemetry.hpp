#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/state/cycle_sample.hpp"
#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// One sample of the topic `joints` as JSON, appended to `out`: everything a setpoint record holds, every number with
/// all its digits. Written by hand, not through a JSON tree: at full rate it is the daemon's largest output.
void append_joints(const CycleSample& sample, std::string& out);

/// One sample of the topic `drives`.
void append_drives(const CycleSample& sample, std::string& out);

/// A notification's line: `{"jsonrpc":"2.0","method":topic,"params":params}` without a newline.
[[nodiscard]] std::string notification(const char* topic, const std::string& params);

/// The topic `events`.
[[nodiscard]] std::string event_notification(const Event& event);

/// The pace at which one topic goes to one connection, counted in cycles so that no clock is needed.
class TopicPace {
 public:
  [[nodiscard]] bool on() const noexcept { return every_ != 0; }
  [[nodiscard]] std::int64_t every_cycles() const noexcept { return every_; }
  void start(std::int64_t every_cycles) noexcept {
    every_ = every_cycles;
    next_ = 0;
  }
  void stop() noexcept { every_ = 0; }
  /// Whether this cycle's sample is due; counts it when so.
  [[nodiscard]] bool due(std::int64_t cycle) noexcept {
    if (every_ == 0) return false;
    if (cycle < next_ && next_ - cycle <= every_) return false;
    next_ = cycle + every_;
    return true;
  }

 private:
  std::int64_t every_ = 0;
  std::int64_t next_ = 0;
};

}  // namespace rmac::gateway
