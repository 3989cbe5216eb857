#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/api/rpc_error.hpp"
#include "gateway/server/animation_feed.hpp"
#include "gateway/server/telemetry.hpp"

namespace rmac::gateway {

/// A client that receives more samples a second is no watcher but a recorder, of which there is one at a time.
inline constexpr double kWatchRateHz = 100;

/// What one connection is pushed: at which pace each topic goes to it, and what was collected for the next batch.
/// Gives lines; who owns it sends them.
class Subscriptions {
 public:
  /// The topic `state` of a sample, as JSON text.
  using State = std::function<std::string(const CycleSample& sample)>;

  /// `look` tells of the machine for the topic `animation`.
  Subscriptions(double cycle_hz, State state, AnimationFeed::Look look);

  /// An error where there is no such topic.
  [[nodiscard]] static tl::expected<void, RpcError> check(const std::vector<std::string>& topics);
  /// Whether one of the topics goes out at a rate.
  [[nodiscard]] static bool has_rate(const std::vector<std::string>& topics);

  /// Of samples that are taken after cycle `since`.
  void start(const std::vector<std::string>& topics, double rate_hz, std::int64_t since);
  /// Ends the topics, or all of them when none is named.
  void stop(const std::vector<std::string>& topics);
  /// Streams joints and poses of links for an animation, or ends that; what the client subscribed to itself stays as it
  /// is. Of samples that are taken after cycle `since`.
  void animate(bool on, std::int64_t since);
  /// Whether it receives more than the watchers' rate.
  [[nodiscard]] bool is_fast() const noexcept;
  [[nodiscard]] bool has_events() const noexcept { return events_; }

  /// Collects what is due of a sample. Gives the line that goes out at once.
  [[nodiscard]] std::optional<std::string> take(const CycleSample& sample);
  /// Whether the batches should not grow any further.
  [[nodiscard]] bool is_full() const noexcept;
  /// The batches that `take` collected.
  [[nodiscard]] std::vector<std::string> batches();
  /// Whether a state is to go out without waiting for a cycle: the first one, or the last.
  [[nodiscard]] bool owes_state() const noexcept { return owes_state_ && state_.on(); }
  void owe_state() noexcept { owes_state_ = owes_state_ || state_.on(); }
  [[nodiscard]] std::string state_line(const CycleSample& sample);

 private:
  [[nodiscard]] std::vector<TopicPace*> paces(const std::vector<std::string>& topics);

  double cycle_hz_;
  State describe_;
  TopicPace state_, joints_, drives_;
  AnimationFeed animation_;
  /// Cycles between samples before an animation; 0: none went out.
  std::optional<double> joints_before_, animation_before_;
  bool events_ = false;
  bool owes_state_ = false;
  std::string joints_batch_, drives_batch_;
};

}  // namespace rmac::gateway
