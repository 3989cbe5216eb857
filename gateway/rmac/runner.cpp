#include "gateway/rmac/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/rmac/rest.hpp"

namespace rmac::cli {

namespace {

constexpr std::size_t kPipelineRequests = 32;
constexpr double kFullRateHz = 1e6;  // More than any cycle: the appliance gives its own full rate.
constexpr double kWatchRateHz = 100;
constexpr double kStateRateHz = 20;
constexpr auto kRecordBound = std::chrono::seconds(10);

}  // namespace

Runner::Runner(Connection& connection, RunOptions options)
    : connection_(connection), options_(std::move(options)), progress_(options_.show_progress) {
  connection_.on_notification([this](const auto& topic, const auto& params) { take(topic, params); });
  connection_.on_entered_line([this](const std::string& line) { obey(line); });
}

Result<RunReport> Runner::run(const Program& program) {
  const auto begin = std::chrono::steady_clock::now();
  total_moves_ = program.moves;
  auto done = prepare(program);
  if (done) {
    done = stream(program);
    if (!done) {
      halt();
    }
  }
  // Nothing of this program moves any more, so giving the lease back stops nothing.
  if (leased_) {
    if (auto released = connection_.call("authority.release"); done && !released) {
      done = tl::unexpected(released.error());
    }
  }
  progress_.clear();
  if (record_) {
    report_.record_rows = record_->rows();
    report_.record_files = record_->files();
    if (auto closed = record_->close(); done && !closed) {
      done = closed;
    }
    if (done && record_->missing_cycles() > 0) {
      done =
          fail(fmt::format("the record lacks {} cycles: another client has the full rate", record_->missing_cycles()));
    }
  }
  if (!done) {
    return tl::unexpected(done.error());
  }
  report_.requests = program.requests.size();
  report_.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report_;
}

Result<> Runner::prepare(const Program& program) {
  if (!options_.record_file.empty()) {
    record_.emplace(options_.record_file);
    if (auto opened = record_->open(); !opened) {
      return opened;
    }
  }
  const auto& limits = connection_.greeting().value("limits", nlohmann::json::object());
  queue_bound_ = limits.value("queue_capacity", std::size_t{0});
  // A move refused for want of room, while later ones are already on their way, would leave a gap in the part. So there
  // is a window only where the appliance said how much it holds.
  window_ = queue_bound_ > 0 ? kPipelineRequests : 1;
  auto lease = connection_.call("authority.acquire");
  if (!lease) {
    return tl::unexpected(lease.error());
  }
  if (const double timeout_s = lease->value("timeout_s", 0.0); timeout_s > 0) {
    renew_every_ = std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1000 / 3) + 1);
  }
  leased_ = true;
  if (auto topics = connection_.call("subscribe", {{"topics", {"events"}}}); !topics) {
    return tl::unexpected(topics.error());
  }
  if (auto topics = connection_.call("subscribe", {{"topics", {"state"}}, {"rate_hz", kStateRateHz}}); !topics) {
    return tl::unexpected(topics.error());
  }
  std::string machine = options_.machine;
  if (machine.empty() && options_.virtual_mode && !program.loads_mechanism) {
    auto loaded = connection_.call("Device.Machine_GetMechanismName");
    if (!loaded) {
      return tl::unexpected(loaded.error());
    }
    machine = loaded->get<std::string>();
  }
  if (!machine.empty()) {
    if (auto loaded = connection_.call("Device.Load", {{"Name", machine}, {"Virtual", options_.virtual_mode}});
        !loaded) {
      return tl::unexpected(loaded.error());
    }
  }
  auto state = connection_.call("RMAC_CAM.GetState");
  if (!state) {
    return tl::unexpected(state.error());
  }
  state_ = read_state(*state);
  if (state_->moves_in_buffer > 0) {
    return fail(fmt::format("{} moves of an earlier program are still queued: end them with `rmac stop` first",
                            state_->moves_in_buffer));
  }
  return {};
}

Result<> Runner::stream(const Program& program) {
  for (const auto& request : program.requests) {
    if (auto submitted = submit(program, request); !submitted) {
      return submitted;
    }
  }
  if (!unfinished_.empty() && !started_) {
    return fail(fmt::format("{}: the program ends without starting its cycle", program.file));
  }
  return settle();
}

Result<> Runner::submit(const Program& program, const Request& request) {
  const auto place = fmt::format("{}:{}", program.file, request.line);
  if (request.timing == Timing::Settled) {
    if (!unfinished_.empty() && !started_) {
      return fail(fmt::format("{}: {} needs the moves before it done, but the program starts its cycle later", place,
                              request.method));
    }
    if (auto settled = settle(); !settled) {
      return settled;
    }
  }
  if (request.timing == Timing::Start && unsettled_) {
    if (auto settled = settle(); !settled) {
      return settled;
    }
    unsettled_ = false;
  }
  const bool is_move = request.timing == Timing::Move;
  if (measuring_ && started_) {
    // A measured point ends where the part is: what comes next begins there.
    if (auto measured = wait([&] { return unanswered_ == 0 && unfinished_.empty(); }); !measured) {
      return measured;
    }
  }
  measuring_ = measures(request.method);
  if (is_move) {
    if (auto ready = before_move(program); !ready) {
      return ready;
    }
  }
  const auto room = [&] {
    const bool queue_has_room = !is_move || !started_ || queue_bound_ == 0 || unfinished_.size() < queue_bound_;
    return unanswered_ < window_ && queue_has_room && !parked_;
  };
  if (auto waited = wait(room); !waited) {
    return waited;
  }
  auto params = request.params();
  if (request.method == "Device.Load" && options_.virtual_mode && params.is_object()) {
    params["Virtual"] = true;
  }
  ++unanswered_;
  if (is_move) {
    unfinished_.push_back(request.tool_change ? std::nullopt : std::optional(request.move_id));
  }
  started_ = started_ || request.timing == Timing::Start;
  unsettled_ = unsettled_ || request.timing == Timing::Settled;
  connection_.send(request.method, params, [this, place, method = request.method](const Connection::Answer& answer) {
    --unanswered_;
    if (!answer) {
      fail_with(fmt::format("{}: {}: {}", place, method, answer.error().message));
    }
  });
  return {};
}

Result<> Runner::before_move(const Program& program) {
  if (auto watching = watch_joints(); !watching) {
    return watching;
  }
  if (!unsettled_) {
    return {};
  }
  // A jog, a home or a swapped mechanism: its motion must have ended, and the cycle may have with it.
  if (auto settled = settle(); !settled) {
    return settled;
  }
  unsettled_ = false;
  return program.starts_cycle ? Result<>() : start_cycle();
}

Result<> Runner::start_cycle() {
  // Answered before the first move goes out: a refusal (a fault, drives that are not ready) is then the only message.
  // A jog that just came to rest is refused for as long as the machine needs to see it, so one refusal proves nothing.
  constexpr int kAutomatic = 1;
  constexpr auto kPause = std::chrono::milliseconds(20);
  constexpr int kTries = 50;
  Connection::Answer started = fail("");
  for (int tries = 0; tries < kTries && !started; ++tries) {
    if (tries > 0) {
      if (auto waited = connection_.wait([&] { return !failure_.empty(); }, kPause); !waited || *waited) {
        break;
      }
    }
    started = connection_.call("RMAC_CAM.CycleStart", {{"Mode", kAutomatic}});
  }
  if (!started) {
    return tl::unexpected(started.error());
  }
  started_ = true;
  return {};
}

Result<> Runner::settle() {
  if (auto done = wait([&] { return unanswered_ == 0 && unfinished_.empty(); }); !done) {
    return done;
  }
  if (auto rested = rest(); !rested || !record_ || !watching_) {
    return rested;
  }
  // The last cycles of a record come in a batch of their own, perhaps after the state.
  const auto complete =
      connection_.wait([&] { return last_sample_s_ >= last_done_s_ || !failure_.empty(); }, kRecordBound);
  if (!complete) {
    return tl::unexpected(complete.error());
  }
  return *complete ? Result<>() : fail("the record is not complete: the joints of the last cycles did not come");
}

Result<> Runner::rest() {
  // Home and jog have no MoveID, so the machine itself is asked.
  auto state = wait_for_rest(connection_, failure_);
  if (!state) {
    return tl::unexpected(state.error());
  }
  state_ = std::move(*state);
  return {};
}

Result<> Runner::watch_joints() {
  if (watching_) {
    return {};
  }
  watching_ = true;
  const auto rate_hz = record_ ? kFullRateHz : kWatchRateHz;
  report_.every_cycle_seen = record_.has_value();
  auto subscribed = connection_.call("subscribe", {{"topics", {"joints"}}, {"rate_hz", rate_hz}});
  return subscribed ? Result<>() : tl::unexpected(subscribed.error());
}

Result<> Runner::wait(const std::function<bool()>& done) {
  for (;;) {
    auto waited = connection_.wait([&] { return !failure_.empty() || rest_told_ || done(); }, renew_every_);
    if (!waited) {
      return tl::unexpected(waited.error());
    }
    if (!*waited) {
      connection_.send("authority.renew", nlohmann::json::object(), [](const Connection::Answer&) {});
      continue;
    }
    if (!failure_.empty()) {
      return fail(failure_);
    }
    if (!rest_told_) {
      return {};
    }
    rest_told_ = false;
    if (auto explained = explain_rest(); !explained) {
      return explained;
    }
  }
}

Result<> Runner::explain_rest() {
  // A jog, or a move in manual mode, ends at rest as it should. So does a machine that another client stopped.
  auto answer = connection_.call("RMAC_CAM.GetState");
  if (!answer) {
    return tl::unexpected(answer.error());
  }
  const auto state = read_state(*answer);
  if (parked_) return {};
  if (state.state != "Idle" || unfinished_.empty()) {
    return {};
  }
  const auto queued = unfinished_.size() - std::min(unanswered_, unfinished_.size());
  if (static_cast<std::size_t>(state.moves_in_buffer) < queued) {
    return fail(
        fmt::format("the machine was stopped and its queue emptied: {} moves are not done", unfinished_.size()));
  }
  if (state.moves_in_buffer > 0 && state.mode == "AUTOMATIC") {
    return fail(fmt::format("the cycle was stopped: {} moves are not done", unfinished_.size()));
  }
  return {};
}

void Runner::halt() {
  // Anyone connected may stop the machine; a lost connection has stopped it by losing the lease. A program that is
  // parked moves nothing, and who does is somebody else.
  if (parked_) return;
  if (connection_.call("RMAC_CAM.StopNow")) {
    failure_.clear();
    static_cast<void>(rest());
  }
}

void Runner::take(const std::string& topic, const nlohmann::json& params) {
  if (topic == "events") {
    take(read_event(params));
  } else if (topic == "state") {
    state_ = read_state(params);
    progress_.draw(report_.moves, total_moves_,
                   !state_->tool_prompt.empty() ? state_->tool_prompt + ", or Enter"
                   : parked_                    ? (note_.empty() ? "parked: Enter takes it up again" : note_)
                   : state_->state != "Holding" ? fmt::format("{:.0f} mm/min", state_->feed_actual)
                   : note_.empty()              ? "held: Enter goes on, a distance in mm runs back, p parks"
                                                : note_);
  } else if (topic == "joints") {
    for (const auto& sample : read_joints(params)) {
      take(sample);
    }
  }
}

void Runner::take(const EventNote& event) {
  if (parked_) return;  // what happens now is not the program's
  if (event.kind == "MoveStarted" && !first_start_s_ && !unfinished_.empty()) {
    first_start_s_ = event.t_s;
  } else if (event.kind == "MoveDone" && !unfinished_.empty() && unfinished_.front() == event.move_id) {
    unfinished_.pop_front();
    ++report_.moves;
    last_done_s_ = event.t_s;
    report_.cycle_time_s = event.t_s - first_start_s_.value_or(event.t_s);
  } else if (event.kind == "ToolWanted") {
    progress_.clear();
    fmt::print(stderr, "rmac: {}\n", event.message);
  } else if (event.kind == "ToolChanged" && !unfinished_.empty() && !unfinished_.front()) {
    unfinished_.pop_front();
  } else if (event.kind == "Fault" || event.kind == "ToolChangeDropped") {
    fail_with(event.message);
  } else if (event.kind == "Stopped") {
    rest_told_ = !unfinished_.empty();
  }
}

void Runner::take(const JointSample& sample) {
  last_sample_s_ = sample.t_s;
  if (report_.following_error.size() < sample.position_set.size()) {
    report_.following_error.resize(sample.position_set.size());
  }
  for (std::size_t joint = 0; joint < std::min(sample.position_set.size(), sample.position.size()); ++joint) {
    report_.following_error[joint] =
        std::max(report_.following_error[joint], std::abs(sample.position_set[joint] - sample.position[joint]));
  }
  // Waiting for the first move is no part of the record; every cycle from there on is.
  if (record_ && (sample.moving || record_->rows() > 0)) {
    if (auto added = record_->add(sample); !added) {
      fail_with(added.error().message);
    }
  }
}

void Runner::fail_with(const std::string& message) {
  if (failure_.empty()) {
    failure_ = message;
  }
}

}  // namespace rmac::cli
