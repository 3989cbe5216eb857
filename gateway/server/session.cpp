#include "gateway/server/session.hpp"

#include <fmt/format.h>

#include "gateway/json/printable.hpp"

namespace rmac::gateway {

Session::Session(const ConnectionContext& context, std::uint64_t id, std::string where, Subscriptions& subscriptions)
    : context_(context),
      id_(id),
      where_(std::move(where)),
      records_(context.make_records()),
      subscriptions_(subscriptions) {}

std::string Session::name() const {
  return client_.empty() ? where_ : fmt::format("{} ({})", client_, where_);
}

void Session::introduce(const std::string& client, const std::string& version) {
  client_ = printable(version.empty() ? client : client + " " + version, kLongestName);
}

nlohmann::json Session::greeting() const {
  const ServerOptions& options = context_.options;
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

bool Session::has_authority() const {
  return context_.lease.held_by(id_);
}

std::string Session::authority_holder() const {
  return context_.lease.holder_name();
}

tl::expected<nlohmann::json, RpcError> Session::acquire_authority() {
  return context_.lease.acquire(id_, name());
}

tl::expected<void, RpcError> Session::renew_authority() {
  return context_.lease.confirm(id_);
}

tl::expected<void, RpcError> Session::release_authority() {
  return context_.lease.confirm(id_).map([&] { context_.lease.lose(id_, name(), "gave back"); });
}

tl::expected<std::string, RpcError> Session::acquire_operator() {
  const bool was = is_operator();
  return context_.operator_post.acquire(id_, name()).map([&] {
    if (!was) context_.peers.announce(Event::Kind::Authority, name() + " is the operator");
    return operator_name();
  });
}

tl::expected<void, RpcError> Session::release_operator() {
  return context_.operator_post.confirm(id_).map([&] { leave_operators_post("gave up"); });
}

void Session::leave_posts(const char* why) {
  context_.lease.lose(id_, name(), why);
  leave_operators_post(why);
}

void Session::leave_operators_post(const char* why) {
  if (!context_.operator_post.leave(id_)) return;
  context_.peers.announce(Event::Kind::Authority,
                          fmt::format("{} {} the operator's place; what it held stays held", name(), why));
}

bool Session::is_operator() const {
  return context_.operator_post.held_by(id_);
}

std::string Session::operator_name() const {
  const OperatorRef now = context_.operator_post.now();
  return now ? now->name() : "";
}

OperatorRef Session::holds_as() const {
  return is_operator() && context_.options.operator_alone_resumes ? context_.operator_post.now() : nullptr;
}

void Session::tell(const std::string& what) {
  context_.peers.announce(Event::Kind::Operator, name() + " " + what);
}

tl::expected<void, RpcError> Session::subscribe(const std::vector<std::string>& topics, double rate_hz) {
  if (auto known = Subscriptions::check(topics); !known) return known;
  if (rate_hz > kWatchRateHz && Subscriptions::has_rate(topics)) {
    if (const auto other = context_.peers.fast_watcher_beside(id_)) {
      return tl::unexpected<RpcError>(
          RpcError{rpc_code::kRateTaken,
                   fmt::format("{} receives more than {} samples a second already, which one client at a time may; ask "
                               "for {} or less",
                               *other, kWatchRateHz, kWatchRateHz),
                   MinorCode::UnsupportedOperation});
    }
  }
  subscriptions_.start(topics, rate_hz, context_.dispatcher.machine().sample().cycle);
  return {};
}

void Session::unsubscribe(const std::vector<std::string>& topics) {
  subscriptions_.stop(topics);
}

void Session::animate(bool on) {
  subscriptions_.animate(on, context_.dispatcher.machine().sample().cycle);
}

}  // namespace rmac::gateway
