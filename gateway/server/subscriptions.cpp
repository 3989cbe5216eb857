#include "gateway/server/subscriptions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/api/topics.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr double kAnimatedJointsHz = 50;  ///< as clients know it that look at joints alone
constexpr double kAnimationHz = 60;
constexpr std::size_t kBatchBytes = 256 * 1024;

bool names(const std::vector<std::string>& topics, const char* topic) {
  return std::ranges::count(topics, topic) > 0;
}

/// Moves a batch out, as a line.
void take_batch(const char* topic, std::string& batch, std::vector<std::string>& lines) {
  if (batch.empty()) return;
  lines.push_back(notification(topic, "{\"samples\":[" + batch + "]}"));
  batch.clear();
}

}  // namespace

Subscriptions::Subscriptions(double cycle_hz, State state, AnimationFeed::Look look)
    : cycle_hz_(cycle_hz), describe_(std::move(state)), animation_(std::move(look)) {}

tl::expected<void, RpcError> Subscriptions::check(const std::vector<std::string>& topics) {
  for (const std::string& topic : topics) {
    if (std::ranges::count(topic::kAll, topic) > 0) continue;
    return tl::unexpected<RpcError>(
        RpcError{rpc_code::kInvalidParams,
                 fmt::format("parameter \"topics\" has \"{}\", expected state, joints, drives, animation or events",
                             printable(topic, kLongestName)),
                 MinorCode::InvalidParameterValue});
  }
  return {};
}

bool Subscriptions::has_rate(const std::vector<std::string>& topics) {
  return std::ranges::any_of(topics, [](const std::string& topic) { return topic != topic::kEvents; });
}

std::vector<TopicPace*> Subscriptions::paces(const std::vector<std::string>& topics) {
  std::vector<TopicPace*> result;
  for (const std::string& topic : topics) {
    if (topic == topic::kState) result.push_back(&state_);
    if (topic == topic::kJoints) result.push_back(&joints_);
    if (topic == topic::kDrives) result.push_back(&drives_);
    if (topic == topic::kAnimation) result.push_back(&animation_.pace());
  }
  return result;
}

void Subscriptions::start(const std::vector<std::string>& topics, double rate_hz, std::int64_t since) {
  const double cycles = std::clamp(std::round(cycle_hz_ / rate_hz), 1.0, 1e12);
  for (TopicPace* pace : paces(topics)) pace->start(cycles, since);
  if (names(topics, topic::kAnimation)) {
    animation_.start(std::max(cycle_hz_ / rate_hz, 1.0), since);
    animation_before_.reset();
  }
  if (names(topics, topic::kJoints)) joints_before_.reset();
  owes_state_ = owes_state_ || names(topics, topic::kState);
  events_ = events_ || names(topics, topic::kEvents);
}

void Subscriptions::stop(const std::vector<std::string>& topics) {
  const bool all = topics.empty();
  const auto ended = paces(all ? std::vector<std::string>(topic::kAll.begin(), topic::kAll.end()) : topics);
  for (TopicPace* pace : ended) pace->stop();
  if (all || names(topics, topic::kEvents)) events_ = false;
}

void Subscriptions::animate(bool on, std::int64_t since) {
  const auto raised = [on](TopicPace& pace, std::optional<double>& before, double every) -> std::optional<double> {
    if (!on) return std::exchange(before, std::nullopt);
    if (pace.on() && pace.every_cycles() <= every) return std::nullopt;
    before = pace.every_cycles();
    return every;
  };
  const double joints_every = std::max(std::round(cycle_hz_ / kAnimatedJointsHz), 1.0);
  if (const auto every = raised(joints_, joints_before_, joints_every)) joints_.start(*every, since);
  const double animation_every = std::max(cycle_hz_ / kAnimationHz, 1.0);
  if (const auto every = raised(animation_.pace(), animation_before_, animation_every)) animation_.start(*every, since);
}

bool Subscriptions::is_fast() const noexcept {
  return std::ranges::any_of(std::array{&state_, &joints_, &drives_, &animation_.pace()}, [&](const TopicPace* pace) {
    return pace->on() && pace->every_cycles() < cycle_hz_ / kWatchRateHz;
  });
}

std::optional<std::string> Subscriptions::take(const CycleSample& sample) {
  if (joints_.due(sample.cycle)) {
    if (!joints_batch_.empty()) joints_batch_ += ',';
    append_joints(sample, joints_batch_);
  }
  if (drives_.due(sample.cycle)) {
    if (!drives_batch_.empty()) drives_batch_ += ',';
    append_drives(sample, drives_batch_);
  }
  animation_.take(sample);
  if (!state_.due(sample.cycle)) return std::nullopt;
  return state_line(sample);
}

bool Subscriptions::is_full() const noexcept {
  return joints_batch_.size() + drives_batch_.size() + animation_.bytes() > kBatchBytes;
}

std::vector<std::string> Subscriptions::batches() {
  std::vector<std::string> lines;
  take_batch(topic::kJoints, joints_batch_, lines);
  take_batch(topic::kDrives, drives_batch_, lines);
  animation_.take_out(lines);
  return lines;
}

std::string Subscriptions::state_line(const CycleSample& sample) {
  owes_state_ = false;
  return notification(topic::kState, describe_(sample));
}

}  // namespace rmac::gateway
