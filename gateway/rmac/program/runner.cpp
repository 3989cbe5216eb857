#include "gateway/rmac/program/runner.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

constexpr std::size_t kPipelineRequests = 32;
constexpr double kStateRateHz = 20;
constexpr auto kRecordBound = std::chrono::seconds(10);

}  // namespace

Runner::Runner(Connection& connection, const Program& program, RunOptions options)
    : connection_(connection),
      program_(program),
      options_(std::move(options)),
      progress_(options_.show_progress),
      order_(program),
      prompt_(connection, moves_),
      joints_(options_.record_file, options_.on_cycle) {
  connection_.on_notification([this](const auto& topic, const auto& params) { take(topic, params); });
  connection_.on_entered_line(options_.terminal, [this](const std::string& line) { prompt_.obey(line); });
}

Runner::~Runner() {
  connection_.on_notification({});
  connection_.on_entered_line({}, {});
}

Result<RunReport> Runner::run() {
  const auto begin = std::chrono::steady_clock::now();
  auto done = prepare();
  if (done) {
    done = stream();
    if (!done) halt();
  }
  done = finish(std::move(done));
  if (!done) return tl::unexpected(done.error());
  return report(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

Result<> Runner::finish(Result<> done) {
  // Nothing of this program moves any more, so giving the lease back stops nothing.
  if (leased_) {
    if (auto released = connection_.command(kReleaseAuthority); done && !released) done = released;
  }
  progress_.clear();
  auto closed = joints_.close();
  return done ? closed : done;
}

RunReport Runner::report(double wall_time_s) const {
  RunReport report;
  report.requests = program_.requests.size();
  report.moves = moves_.moves_done();
  report.cycle_time_s = moves_.cycle_time_s();
  report.wall_time_s = wall_time_s;
  report.following_error = joints_.following_error();
  report.every_cycle_seen = joints_.sees_every_cycle();
  if (const auto& record = joints_.record()) {
    report.record_rows = record->rows();
    report.record_files = record->files();
  }
  return report;
}

Result<> Runner::prepare() {
  if (auto opened = joints_.open(); !opened) return opened;
  const auto& limits = connection_.greeting().value("limits", nlohmann::json::object());
  queue_bound_ = limits.value("queue_capacity", std::size_t{0});
  // A move refused for want of room, while later ones are already on their way, would leave a gap in the part. So there
  // is a window only where the appliance said how much it holds.
  window_ = queue_bound_ > 0 ? kPipelineRequests : 1;
  if (auto acquired = acquire(); !acquired) return acquired;
  if (auto heard = subscribe(connection_, kEventsTopic); !heard) return heard;
  if (auto heard = subscribe(connection_, kStateTopic, kStateRateHz); !heard) return heard;
  if (auto loaded = load(); !loaded) return loaded;
  auto state = ask_state(connection_);
  if (!state) return tl::unexpected(state.error());
  if (state->moves_in_buffer > 0) {
    return fail(fmt::format("{} moves of an earlier program are still queued: end them with `rmac stop` first",
                            state->moves_in_buffer));
  }
  prompt_.hear(std::move(*state));
  return teach();
}

Result<> Runner::teach() {
  if (options_.learned.is_null()) return {};
  return connection_.command(kSetLearnedOffsets, {{"Learned", options_.learned}});
}

Result<> Runner::acquire() {
  const auto lease = connection_.call(kAcquireAuthority);
  if (!lease) return tl::unexpected(lease.error());
  if (const double timeout_s = lease->value("timeout_s", 0.0); timeout_s > 0) {
    renew_every_ = std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1000 / 3) + 1);
  }
  leased_ = true;
  return {};
}

Result<> Runner::load() {
  std::string machine = options_.machine;
  if (machine.empty() && options_.virtual_mode && !program_.loads_mechanism) {
    auto loaded = loaded_machine(connection_);
    if (!loaded) return tl::unexpected(loaded.error());
    machine = std::move(*loaded);
  }
  return machine.empty() ? Result<>() : load_machine(connection_, machine, options_.virtual_mode);
}

Result<> Runner::stream() {
  for (const auto& request : program_.requests) {
    if (auto submitted = submit(request); !submitted) return submitted;
  }
  if (auto ended = order_.check_end(!moves_.empty()); !ended) return ended;
  return settle();
}

Result<> Runner::submit(const Request& request) {
  if (auto possible = order_.check(request, !moves_.empty()); !possible) return possible;
  const bool is_move = request.timing == Timing::Move;
  if (is_move) {
    if (auto watching = joints_.begin(connection_); !watching) return watching;
  }
  // A jog, a home or a swapped mechanism: its motion must have ended, and the cycle may have with it.
  if (auto settled = order_.waits_for_rest(request) ? settle() : Result<>(); !settled) return settled;
  if (auto measured = order_.waits_for_measurement() ? wait_for_moves() : Result<>(); !measured) return measured;
  if (auto started = order_.needs_cycle(request) ? start_cycle_of_moves() : Result<>(); !started) return started;
  auto params = request.params();
  const auto reach = OpenEnds::of(params);
  const auto room = [&] {
    const bool queue_has_room = !is_move || !order_.started() || queue_bound_ == 0 || moves_.size() < queue_bound_;
    return unanswered_ < window_ && queue_has_room && (!is_move || ends_.may_follow(reach)) && !prompt_.parked();
  };
  if (auto waited = wait(room); !waited) return waited;
  send(request, std::move(params), reach);
  return {};
}

void Runner::send(const Request& request, nlohmann::json params, const OpenEnds::Reach& reach) {
  if (loads_mechanism(request) && options_.virtual_mode && params.is_object()) params["Virtual"] = true;
  ++unanswered_;
  if (request.timing == Timing::Move) {
    moves_.sent(request);
    ends_.sent(reach);
  } else if (request.timing == Timing::Settled) {
    ends_.forget();
  }
  order_.sent(request);
  connection_.send(request.method, params, [this, &request](const Connection::Answer& answer) {
    --unanswered_;
    if (request.timing == Timing::Move) ends_.answered();
    if (answer) return;
    fail_with(fmt::format("{}:{}: {}: {}", program_.file, request.line, request.method, answer.error().message));
  });
}

Result<> Runner::start_cycle_of_moves() {
  // Answered before the first move goes out: a refusal (a fault, drives that are not ready) is then the only message.
  // A jog that just came to rest is refused for as long as the machine needs to see it, so one refusal proves nothing.
  constexpr auto kPause = std::chrono::milliseconds(20);
  constexpr int kTries = 50;
  auto started = start_cycle(connection_);
  for (int tries = 1; tries < kTries && !started; ++tries) {
    if (auto waited = connection_.wait([&] { return !failure_.empty(); }, kPause); !waited || *waited) break;
    started = start_cycle(connection_);
  }
  if (started) order_.cycle_started();
  return started;
}

Result<> Runner::settle() {
  if (auto done = wait_for_moves(); !done) return done;
  if (auto rested = rest(); !rested || !joints_.waits_for(moves_.last_done_s())) return rested;
  // The last cycles of a record come in a batch of their own, perhaps after the state.
  const auto complete =
      connection_.wait([&] { return !joints_.waits_for(moves_.last_done_s()) || !failure_.empty(); }, kRecordBound);
  if (!complete) return tl::unexpected(complete.error());
  return *complete ? Result<>() : fail("the record is not complete: the joints of the last cycles did not come");
}

Result<> Runner::wait_for_moves() {
  return wait([&] { return unanswered_ == 0 && moves_.empty(); });
}

Result<> Runner::rest() {
  auto state = wait_for_rest(connection_, failure_);
  if (!state) return tl::unexpected(state.error());
  prompt_.hear(std::move(*state));
  return {};
}

Result<> Runner::wait(const std::function<bool()>& done) {
  for (;;) {
    auto waited = connection_.wait([&] { return !failure_.empty() || rest_told_ || done(); }, renew_every_);
    if (!waited) return tl::unexpected(waited.error());
    if (!*waited) {
      connection_.send(kRenewAuthority, nlohmann::json::object(), [](const Connection::Answer&) {});
      continue;
    }
    if (!failure_.empty()) return fail(failure_);
    if (!rest_told_) return {};
    rest_told_ = false;
    if (auto explained = explain_rest(); !explained) return explained;
  }
}

Result<> Runner::explain_rest() {
  // A jog, or a move in manual mode, ends at rest as it should. So does a machine that another client stopped.
  const auto state = ask_state(connection_);
  if (!state) return tl::unexpected(state.error());
  if (prompt_.parked() || !state->is(gateway::CycleState::Idle) || moves_.empty()) return {};
  const auto queued = moves_.size() - std::min(unanswered_, moves_.size());
  if (static_cast<std::size_t>(state->moves_in_buffer) < queued) {
    return fail(fmt::format("the machine was stopped and its queue emptied: {} moves are not done", moves_.size()));
  }
  if (state->moves_in_buffer > 0 && state->mode == name_of(sdk::CycleMode::Automatic)) {
    return fail(fmt::format("the cycle was stopped: {} moves are not done", moves_.size()));
  }
  return {};
}

void Runner::halt() {
  // Anyone connected may stop the machine; a lost connection has stopped it by losing the lease. A program that is
  // parked moves nothing, and who does is somebody else.
  if (prompt_.parked()) return;
  if (stop_now(connection_)) {
    failure_.clear();
    static_cast<void>(rest());
  }
}

void Runner::take(const std::string& topic, const nlohmann::json& params) {
  if (topic == kEventsTopic) {
    take(read_event(params));
  } else if (topic == kStateTopic) {
    prompt_.hear(read_state(params));
    progress_.draw(moves_.moves_done(), program_.moves, prompt_.text());
  } else if (topic == kJointsTopic) {
    if (auto taken = joints_.take(params); !taken) fail_with(taken.error().message);
  }
}

void Runner::take(const EventNote& event) {
  using Kind = gateway::Event::Kind;
  if (prompt_.parked()) return;  // what happens now is not the program's
  if (event.is(Kind::MoveStarted)) {
    moves_.started(event.t_s);
  } else if (event.is(Kind::MoveDone)) {
    moves_.done(event.move_id, event.t_s);
  } else if (event.is(Kind::ToolWanted) || event.is(Kind::Operator) || event.is(Kind::ProgramStopped) ||
             event.is(Kind::NotChecked)) {
    progress_.clear();
    fmt::print(stderr, "rmac: {}\n", event.message);
  } else if (event.is(Kind::ToolChanged)) {
    moves_.tool_changed();
  } else if (event.is(Kind::Fault) || event.is(Kind::ToolChangeDropped) || event.is(Kind::CollisionAhead)) {
    fail_with(event.message);
  } else if (event.is(Kind::Stopped)) {
    rest_told_ = !moves_.empty();
  }
}

void Runner::fail_with(const std::string& message) {
  if (failure_.empty()) failure_ = message;
}

}  // namespace rmac::cli
