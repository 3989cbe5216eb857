#include "gateway/rmacd/daemon.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <asio.hpp>
#include <cstdlib>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "gateway/appliance/machine.hpp"
#include "gateway/rmacd/clock_watch.hpp"
#include "gateway/rmacd/end_signals.hpp"
#include "gateway/rmacd/state_lock.hpp"
#include "gateway/server/server.hpp"
#include "gateway/servo/sync_clock.hpp"
#include "gateway/threads/cpu_progress.hpp"
#include "gateway/threads/hang_watch.hpp"
#include "gateway/threads/turn_lock.hpp"

namespace rmac::gateway {

namespace {

constexpr std::chrono::microseconds kTick{2000}, kHurriedTick{100};
constexpr std::chrono::seconds kStopBound{10};  ///< for coming to rest before the daemon ends regardless

ControllerOptions controller_options(const Configuration& configuration, std::shared_ptr<Clock> clock) {
  ControllerOptions options;
  options.clock = std::move(clock);
  for (const auto& folder : configuration.module_folders) options.module_folders.push_back(folder.string());
  options.period_s = std::chrono::duration<double>(configuration.period).count();
  options.as_fast_as_computed = configuration.pace == Pace::AsFastAsComputed;
  options.real_time = !options.as_fast_as_computed;
  options.degraded_ok = configuration.real_time.degraded_allowed;
  options.cpu = configuration.real_time.cpu.value_or(-1);
  options.priority = configuration.real_time.priority;
  options.lock_memory = configuration.real_time.lock_memory;
  options.queue_capacity = static_cast<std::size_t>(configuration.queue_capacity);
  options.jog_while_waiting = configuration.jog_while_waiting;
  options.stop_categories = configuration.stop_categories;
  options.max_cycles_lost = configuration.real_time.max_cycles_lost;
  options.flight_recorder = configuration.flight_recorder;
  options.drives_folder = configuration.drives_folder;
  options.tools_folder = configuration.state_folder / "tools";
  return options;
}

/// Null where the timer begins the cycles.
Expected<std::shared_ptr<Clock>> clock_for(const Configuration& configuration) {
  const std::string& interface = configuration.real_time.sync_from;
  if (interface.empty() || configuration.pace != Pace::RealTime) return nullptr;
  return SyncClock::on(interface, std::chrono::duration<double>(configuration.period).count());
}

Verification::Options verification_options(const Configuration& configuration) {
  return {.program = default_folders().verifier,
          .verdicts = configuration.state_folder / "verified",
          .module_folders = configuration.module_folders,
          .period_s = std::chrono::duration<double>(configuration.period).count()};
}

ServerOptions server_options(const Configuration& configuration) {
  ServerOptions options;
  options.tcp = configuration.tcp;
  options.address = configuration.address;
  options.port = configuration.port;
  options.unix_socket = configuration.unix_socket;
  options.cycle_hz = 1 / std::chrono::duration<double>(configuration.period).count();
  options.queue_capacity = configuration.queue_capacity;
  options.throttle_machine = configuration.pace == Pace::AsFastAsComputed;
  options.operator_alone_resumes = configuration.operator_alone_resumes;
  options.lease_timeout = configuration.lease_timeout;
  switch (configuration.lease_lost) {
    case StopCategory::StopKeepPower:
      options.lease_lost = LeaseLostAction::Stop;
      break;
    case StopCategory::StopThenRemovePower:
      options.lease_lost = LeaseLostAction::StopAndPowerOff;
      break;
  }
  return options;
}

/// Where clients connect, for people.
std::string places_of(const Configuration& configuration, std::uint16_t port) {
  const std::string tcp = configuration.tcp ? fmt::format("{}:{}", configuration.address, port) : "";
  const std::string file = configuration.unix_socket.string();
  return tcp + (tcp.empty() || file.empty() ? "" : " and ") + file;
}

/// Nothing of the daemon outlives this, and so no service manager has to kill it (TimeoutStopSec of the unit is 30 s).
constexpr std::chrono::seconds kEndBound{25};

[[noreturn]] void give_up() {
  spdlog::critical(
      "the daemon did not end in {} s, something in it hangs; ending at once, and the drives stop by their "
      "heartbeat",
      kEndBound.count());
  std::_Exit(1);
}

/// CPU time that a request may take: building the longest curves is far below it.
constexpr std::chrono::seconds kGatewayPatience{10};
constexpr std::chrono::seconds kCyclePatience{5};
constexpr std::chrono::milliseconds kPowerBound{1000};
constexpr std::chrono::milliseconds kRestLook{5};

/// Whether servo cycles go on, look by look: a process that was stopped did not look either. One thread.
class CycleCount {
 public:
  [[nodiscard]] bool stand(std::int64_t cycle) noexcept {
    same_ = cycle == last_ ? same_ + 1 : 0;
    last_ = cycle;
    return same_ * HangWatch::kLook > kCyclePatience;
  }

 private:
  std::int64_t last_ = -1;
  int same_ = 0;
};

/// The parts, in the order in which they need each other.
class Daemon {
 public:
  /// `clock`: null for the timer.
  Daemon(std::unique_ptr<DeviceDriverManager> manager, const Configuration& configuration, std::shared_ptr<Clock> clock,
         ServerOptions options)
      : signals_([this](const char* signal) { asio::post(io_, [this, signal] { end(signal); }); }, kEndBound, give_up),
        manager_(std::move(manager)),
        controller_(controller_options(configuration, std::move(clock))),
        verification_(verification_options(configuration)),
        host_(*manager_, controller_, &verification_),
        machine_(controller_, host_, *manager_),
        server_(
            io_, machine_, [this] { return std::make_unique<Records>(*manager_); }, std::move(options)),
        fast_(configuration.pace == Pace::AsFastAsComputed),
        virtual_time_(configuration.period) {}

  Expected<> run(const Configuration& configuration);

 private:
  void schedule_tick();
  void tick();
  void dispatch();
  void end(const char* why);
  void end_when_at_rest();
  [[nodiscard]] std::optional<std::string> what_hangs();
  [[noreturn]] void end_without(const std::string& what);

  asio::io_context io_;
  EndSignals signals_;
  CpuProgress gateway_{kGatewayPatience};
  std::unique_ptr<DeviceDriverManager> manager_;
  Controller controller_;
  Verification verification_;
  DeviceHost host_;
  Machine machine_;
  Server server_;
  asio::steady_timer timer_{io_};
  bool fast_;
  double told_until_s_ = 0;  ///< of the machine's time
  ClockWatch virtual_time_;
  enum class Phase { Serving, Stopping, Leaving } phase_ = Phase::Serving;
  std::chrono::steady_clock::time_point end_by_;
  std::chrono::steady_clock::time_point last_watchdog_;
  std::chrono::microseconds watchdog_period_{0};
  std::optional<CycleCount> cycles_;  ///< in real pace
  std::optional<HangWatch> hangs_;    ///< last: it looks at all the others
};

Expected<> Daemon::run(const Configuration& configuration) {
  controller_.on_sample([this](const CycleSample& sample) {
    told_until_s_ = sample.t_s;
    server_.on_sample(sample);
  });
  controller_.on_event([this](const Event& event) {
    if (event.kind == Event::Kind::Fault) spdlog::error("cycle {}: {}", event.cycle, event.message);
    if (event.kind == Event::Kind::FlightRecord) spdlog::info("{}", event.message);
    if (event.kind == Event::Kind::FlightRecordFailed) spdlog::error("{}", event.message);
    const bool warns = event.kind == Event::Kind::Bus || event.kind == Event::Kind::CollisionAhead ||
                       event.kind == Event::Kind::NotChecked;
    if (warns) spdlog::warn("{}", event.message);
    server_.on_event(event);
  });
  if (auto started = controller_.start(); !started) return started;
  for (const std::string& shortcoming : controller_.real_time_shortcomings()) spdlog::warn("{}", shortcoming);
  if (configuration.autoload) {
    if (auto loaded = host_.load(configuration.autoload->mechanism, configuration.autoload->virtual_mode); !loaded) {
      spdlog::error("autoload of {} failed, the daemon runs without a mechanism: {}", configuration.autoload->mechanism,
                    loaded.error().message);
    }
  }
  if (auto listening = server_.listen(); !listening) {
    controller_.stop();
    return listening;
  }
  const std::string places = places_of(configuration, server_.port());
  spdlog::info("rmacd {} listens on {}", RMAC_VERSION, places);
  sd_notifyf(0, "READY=1\nSTATUS=Listening on %s", places.c_str());
  if (std::uint64_t limit_us = 0; sd_watchdog_enabled(0, &limit_us) > 0) {
    watchdog_period_ = std::chrono::microseconds(limit_us / 3);
  }
  if (!fast_) cycles_.emplace();
  hangs_.emplace([this] { return what_hangs(); }, [this](const std::string& what) { end_without(what); });
  schedule_tick();
  while (!io_.stopped()) {
    try {
      io_.run();
    } catch (const PlannerHangs&) {
      schedule_tick();  // the watch ends the daemon
    }
  }
  hangs_.reset();
  server_.close();
  controller_.stop();
  return {};
}

void Daemon::schedule_tick() {
  // In virtual time the machine goes as fast as its samples are taken, and as it is given what to do; the sockets still
  // get their turn in between. At rest it keeps to the clock.
  const bool hurries =
      fast_ && !virtual_time_.keeps(ClockWatch::Length(told_until_s_), std::chrono::steady_clock::now());
  timer_.expires_after(hurries ? kHurriedTick : kTick);
  timer_.async_wait([this](asio::error_code problem) {
    if (problem) return;
    tick();
    if (!io_.stopped()) schedule_tick();
  });
}

std::optional<std::string> Daemon::what_hangs() {
  if (controller_.last_resort().planner_hangs()) return "the planner hangs in a module of the mechanism";
  if (gateway_.stuck()) {
    return fmt::format("a request has computed for {} s: a module of the mechanism hangs", kGatewayPatience.count());
  }
  if (cycles_ && cycles_->stand(controller_.sample().cycle)) {
    return fmt::format("the servo thread has begun no cycle for {} s: a module or a bus hangs", kCyclePatience.count());
  }
  return std::nullopt;
}

void Daemon::end_without(const std::string& what) {
  controller_.last_resort().keep_at_rest();
  const std::string told = what +
                           "; the machine is brought to rest without it, and the daemon ends: start it again, "
                           "and have the module mended";
  spdlog::critical("{}", told);
  asio::post(io_, [this, told] { server_.announce(Event::Kind::Fault, told); });
  const std::int64_t cycle = controller_.sample().cycle;
  const auto wait_until = [](std::chrono::milliseconds most, auto&& reached) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!reached() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kRestLook);
  };
  wait_until(kPowerBound, [&] { return controller_.sample().cycle != cycle; });
  const bool cycles_go_on = controller_.sample().cycle != cycle;
  wait_until(cycles_go_on ? kStopBound : kPowerBound, [this] { return !controller_.sample().moving; });
  controller_.last_resort().cut_power();
  wait_until(kPowerBound, [this] { return controller_.sample().servo_state == ServoState::Off; });
  std::_Exit(1);
}

void Daemon::dispatch() {
  // Whoever changes the mechanism has the controller until that is done; its samples wait.
  if (!server_.mechanism_changes()) controller_.dispatch();
}

void Daemon::tick() {
  gateway_.made();
  if (server_.may_dispatch() || phase_ != Phase::Serving) dispatch();
  server_.tick();
  // From the tick, so that a gateway thread that hangs is noticed.
  const auto now = std::chrono::steady_clock::now();
  if (watchdog_period_.count() > 0 && now - last_watchdog_ > watchdog_period_) {
    last_watchdog_ = now;
    sd_notify(0, "WATCHDOG=1");
  }
  if (phase_ != Phase::Serving) end_when_at_rest();
}

void Daemon::end(const char* why) {
  spdlog::info("{}: stopping the machine and ending", why);
  sd_notify(0, "STOPPING=1");
  phase_ = Phase::Stopping;
  verification_.cancel();
  end_by_ = std::chrono::steady_clock::now() + kStopBound;
  server_.retire();
}

void Daemon::end_when_at_rest() {
  if (phase_ == Phase::Leaving) {
    // Connections see to their own bound.
    if (server_.connection_count() == 0) io_.stop();
    return;
  }
  // The cycle's own state: a sample does not show yet what was started or stopped last.
  const CycleState state = controller_.cycle_now().state;
  const bool late = std::chrono::steady_clock::now() > end_by_;
  const bool at_rest = state != CycleState::Running && state != CycleState::Holding && state != CycleState::Stopping &&
                       !controller_.sample().moving && !server_.mechanism_changes();
  if (!at_rest && !late) return;
  if (late) spdlog::error("the machine did not come to rest in {} s; ending regardless", kStopBound.count());
  dispatch();  // what its last cycles did, before clients are let go
  server_.dismiss();
  phase_ = Phase::Leaving;
}

}  // namespace

Expected<> run_daemon(const Configuration& configuration) {
  EndSignals::block();
  std::error_code problem;
  std::filesystem::create_directories(configuration.state_folder, problem);
  if (!configuration.unix_socket.empty()) {
    std::filesystem::create_directories(configuration.unix_socket.parent_path(), problem);
  }
  const auto lock = StateLock::take(configuration.state_folder);
  if (!lock) return tl::unexpected(lock.error());
  auto manager = DeviceDriverManager::open({.device_tree = configuration.device_tree,
                                            .database = configuration.database,
                                            .searcher = default_folders().searcher});
  if (!manager) return tl::unexpected<Error>(std::move(manager.error()));
  return clock_for(configuration).and_then([&](std::shared_ptr<Clock> clock) {
    return Daemon(std::move(*manager), configuration, std::move(clock), server_options(configuration))
        .run(configuration);
  });
}

}  // namespace rmac::gateway
