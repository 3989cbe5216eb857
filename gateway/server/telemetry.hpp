#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/bodies/link_poses.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// One sample of the topic `joints` as JSON, appended to `out`: everything a setpoint record holds, every number with
/// all its digits. Written by hand, not through a JSON tree: at full rate it is the daemon's largest output.
void append_joints(const CycleSample& sample, std::string& out);

/// One sample of the topic `drives`.
void append_drives(const CycleSample& sample, std::string& out);

/// One sample of the topic `animation`: where the measured joints have the links of their machine.
void append_animation(const CycleSample& sample, const LinkPoses& links, std::string& out);

/// `{"p": …, "q": …}`
void append_frame(const Frame& frame, std::string& out);

/// A notification's line: `{"jsonrpc":"2.0","method":topic,"params":params}` without a newline.
[[nodiscard]] std::string notification(const char* topic, const std::string& params);

/// The topic `events`.
[[nodiscard]] std::string event_notification(const Event& event);

/// The pace at which one topic goes to one connection, counted in cycles so that no clock is needed. Where a period is
/// no whole number of cycles, cycles between samples are now one fewer, now one more.
class TopicPace {
 public:
  [[nodiscard]] bool on() const noexcept { return every_ != 0; }
  [[nodiscard]] double every_cycles() const noexcept { return every_; }
  /// With the first cycle after `since`: samples are told some time after they were taken, and one from before a client
  /// asked would tell it of a machine that it has changed meanwhile. A topic that is told already goes on without a
  /// gap.
  void start(double every_cycles, std::int64_t since) noexcept {
    if (on()) {
      next_ = std::max(first_, next_ + std::min(every_cycles - every_, 0.0));
    } else {
      next_ = first_ = static_cast<double>(since + 1);
    }
    every_ = every_cycles;
  }
  void stop() noexcept { every_ = 0; }
  /// Whether this cycle's sample is due; counts it when so.
  [[nodiscard]] bool due(std::int64_t cycle) noexcept {
    if (every_ == 0) return false;
    const auto now = static_cast<double>(cycle);
    if (now < next_) return false;
    const bool in_step = now - next_ < 1;
    next_ = (in_step ? next_ : now) + every_;
    return true;
  }

 private:
  double every_ = 0;
  double first_ = 0;  ///< the first cycle that may be told
  double next_ = 0;
};

}  // namespace rmac::gateway
