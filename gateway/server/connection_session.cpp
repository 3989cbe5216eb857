// What methods ask of their connection: greeting, authority, topics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/api/state_json.hpp"
#include "gateway/json/printable.hpp"
#include "gateway/server/connection.hpp"
#include "gateway/server/server.hpp"

namespace rmac::gateway {

namespace {

constexpr double kWatchRateHz = 100;
constexpr double kAnimationRateHz = 50;
constexpr std::size_t kBatchBytes = 256 * 1024;
constexpr std::size_t kLongestName = 64;

}  // namespace

void Connection::introduce(const std::string& client, const std::string& version) {
  client_ = printable(version.empty() ? client : client + " " + version, kLongestName);
}

nlohmann::json Connection::greeting() const {
  const ServerOptions& options = server_.options();
  return {{"server", "rmacd"},
          {"version", RMAC_VERSION},
          {"connection", id_},
          {"units",
           {{"length", "mm"},
            {"angle", "deg"},
            {"feed", "mm/min"},
            {"joint_speed", "mm/s or deg/s"},
            {"acceleration", "mm/s^2 or deg/s^2"},
            {"jerk", "mm/s^3 or deg/s^3"},
            {"spindle", "rpm"},
            {"time", "s"},
            {"effort", "N or N*m"}}},
          {"limits",
           {{"line_bytes", options.line_limit_bytes},
            {"nesting", kLargestNesting},
            {"queue_capacity", options.queue_capacity},
            {"queue_wait_s", std::chrono::duration<double>(options.queue_wait).count()},
            {"watch_rate_hz", kWatchRateHz},
            {"cycle_hz", options.cycle_hz}}}};
}

bool Connection::has_authority() const {
  return server_.lease().held_by(id_);
}

std::string Connection::authority_holder() const {
  return server_.lease().holder_name();
}

tl::expected<nlohmann::json, RpcError> Connection::acquire_authority() {
  return server_.acquire_lease(*this);
}

tl::expected<void, RpcError> Connection::renew_authority() {
  return server_.lease().confirm(id_);
}

tl::expected<void, RpcError> Connection::release_authority() {
  return server_.lease().confirm(id_).map([&] { server_.lose_lease(*this, "gave back"); });
}

std::vector<TopicPace*> Connection::paces(const std::vector<std::string>& topics) {
  std::vector<TopicPace*> result;
  for (const std::string& topic : topics) {
    if (topic == "state") result.push_back(&state_);
    if (topic == "joints") result.push_back(&joints_);
    if (topic == "drives") result.push_back(&drives_);
  }
  return result;
}

tl::expected<void, RpcError> Connection::subscribe(const std::vector<std::string>& topics, double rate_hz) {
  for (const std::string& topic : topics) {
    if (topic != "state" && topic != "joints" && topic != "drives" && topic != "events") {
      return tl::unexpected<RpcError>(
          RpcError{rpc_code::kInvalidParams,
                   fmt::format("parameter \"topics\" has \"{}\", expected state, joints, drives or events",
                               printable(topic, kLongestName)),
                   MinorCode::InvalidParameterValue});
    }
  }
  const auto wanted = paces(topics);
  if (rate_hz > kWatchRateHz && !wanted.empty()) {
    if (const Connection* other = server_.fast_watcher_beside(*this)) {
      return tl::unexpected<RpcError>(RpcError{
          rpc_code::kRateTaken,
          fmt::format(
              "{} receives more than {} samples a second already, which one client at a time may; ask for {} or "
              "less",
              other->name(), kWatchRateHz, kWatchRateHz),
          MinorCode::UnsupportedOperation});
    }
  }
  const double cycles = std::clamp(std::round(server_.options().cycle_hz / rate_hz), 1.0, 1e12);
  for (TopicPace* pace : wanted) pace->start(static_cast<std::int64_t>(cycles));
  if (std::ranges::count(topics, "joints") > 0) joints_before_animation_.reset();
  state_now_ = state_now_ || std::ranges::count(topics, "state") > 0;
  events_ = events_ || std::ranges::count(topics, "events") > 0;
  return {};
}

void Connection::unsubscribe(const std::vector<std::string>& topics) {
  const bool all = topics.empty();
  const auto ended = paces(all ? std::vector<std::string>{"state", "joints", "drives"} : topics);
  for (TopicPace* pace : ended) pace->stop();
  if (all || std::ranges::count(topics, "events") > 0) events_ = false;
}

void Connection::animate(bool on) {
  const std::int64_t every = std::max(std::llround(server_.options().cycle_hz / kAnimationRateHz), 1LL);
  if (on && (!joints_.on() || joints_.every_cycles() > every)) {
    joints_before_animation_ = joints_.every_cycles();
    joints_.start(every);
  } else if (!on && joints_before_animation_) {
    const std::int64_t before = *std::exchange(joints_before_animation_, std::nullopt);
    joints_.start(before);
  }
}

bool Connection::watches_fast() const noexcept {
  return std::ranges::any_of(std::array{&state_, &joints_, &drives_}, [&](const TopicPace* pace) {
    return pace->on() && static_cast<double>(pace->every_cycles()) < server_.options().cycle_hz / kWatchRateHz;
  });
}

void Connection::push_sample(const CycleSample& sample) {
  if (joints_.due(sample.cycle)) {
    if (!joints_batch_.empty()) joints_batch_ += ',';
    append_joints(sample, joints_batch_);
  }
  if (drives_.due(sample.cycle)) {
    if (!drives_batch_.empty()) drives_batch_ += ',';
    append_drives(sample, drives_batch_);
  }
  if (state_.due(sample.cycle)) {
    state_now_ = false;
    Dispatcher& api = server_.dispatcher();
    send(notification("state", text_of(state_to_json(api.machine(), sample, api.status(), authority_holder()))));
  }
  if (joints_batch_.size() + drives_batch_.size() > kBatchBytes) flush_topics();
}

void Connection::push_event(const std::string& line) {
  if (!events_) return;
  // What happened after a sample is told after it.
  flush_topics();
  send(line);
}

void Connection::flush_topics() {
  if (!joints_batch_.empty()) {
    send(notification("joints", "{\"samples\":[" + joints_batch_ + "]}"));
    joints_batch_.clear();
  }
  if (!drives_batch_.empty()) {
    send(notification("drives", "{\"samples\":[" + drives_batch_ + "]}"));
    drives_batch_.clear();
  }
  if (state_now_ && state_.on() && !server_.mechanism_changes()) {
    state_now_ = false;
    Dispatcher& api = server_.dispatcher();
    send(notification("state",
                      text_of(state_to_json(api.machine(), api.machine().sample(), api.status(), authority_holder()))));
  }
}

}  // namespace rmac::gateway
