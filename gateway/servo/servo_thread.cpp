#include "gateway/servo/servo_thread.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <future>

namespace rmac::gateway {

namespace {
/// How long virtual time stands still before it looks again whether it may go on.
constexpr std::chrono::microseconds kStandstill{50};
/// More planning than this in one cycle means that the planner waits for the cycle.
constexpr int kMostPlanningPasses = 1000;
}  // namespace

ServoThread::ServoThread(Options options, ServoLink& link, Planning& planning)
    : options_(std::move(options)), link_(link), planning_(planning) {
  if (!options_.clock) options_.clock = make_monotonic_clock(options_.period_s);
}

ServoThread::~ServoThread() {
  stop();
}

Expected<> ServoThread::start() {
  link_.history.restart();
  link_.delivered.store(0);
  if (options_.stepped) {
    stepped_.emplace(link_, options_.period_s);
    return {};
  }
  stop_.store(false);
  std::promise<std::vector<std::string>> granted;
  auto answer = granted.get_future();
  servo_ = std::thread([this, &granted] {
    granted.set_value(options_.real_time ? enter_real_time(options_.wish) : std::vector<std::string>{});
    ServoCycle cycle(link_, options_.period_s);
    if (options_.virtual_time) {
      run_virtual(cycle);
    } else {
      run_real(cycle);
    }
  });
  shortcomings_ = answer.get();
  if (!shortcomings_.empty() && !options_.degraded_ok) {
    stop();
    return failure(MinorCode::Other, fmt::format("real time is wanted and not granted: {}; or allow degraded operation",
                                                 fmt::join(shortcomings_, "; ")));
  }
  if (!options_.virtual_time) planner_ = std::thread([this] { plan(); });
  return {};
}

void ServoThread::stop() noexcept {
  stop_.store(true);
  if (servo_.joinable()) servo_.join();
  if (planner_.joinable()) planner_.join();
}

void ServoThread::step() {
  int passes = 0;
  while (planning_.advance(stepped_->status()) == Planning::Pace::Planning && ++passes < kMostPlanningPasses) {
  }
  stepped_->run(0);
}

void ServoThread::run_real(ServoCycle& cycle) noexcept {
  options_.clock->restart();
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::uint64_t missed = options_.clock->wait_for_cycle();
    link_.times.wake_up.add(options_.clock->late_ns());
    run_timed(cycle, missed);
  }
}

void ServoThread::run_timed(ServoCycle& cycle, std::uint64_t missed) noexcept {
  const auto begun = std::chrono::steady_clock::now();
  cycle.run(missed);
  const std::int64_t all_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now() - begun).count();
  link_.times.compute.add(all_ns - cycle.exchange_ns());
  link_.times.bus.add(cycle.exchange_ns());
}

void ServoThread::plan() {
  const auto tick = std::chrono::nanoseconds(static_cast<std::int64_t>(options_.period_s * 1e9));
  while (!stop_.load(std::memory_order_relaxed)) {
    if (planning_.advance(link_.status.read()) != Planning::Pace::Planning) planning_.wait_for_work(tick);
  }
}

void ServoThread::run_virtual(ServoCycle& cycle) {
  bool calm = false;
  int passes = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    // Nobody may miss a cycle in virtual time: the machine waits for its readers.
    if (link_.history.newest() - link_.delivered.load(std::memory_order_acquire) >= kMostUndelivered ||
        link_.history.would_overwrite()) {
      std::this_thread::sleep_for(kStandstill);
      continue;
    }
    const auto pace = planning_.advance(cycle.status());
    if (pace == Planning::Pace::Planning && ++passes < kMostPlanningPasses) continue;
    passes = 0;
    if (pace == Planning::Pace::Sending) {
      std::this_thread::sleep_for(kStandstill);
      continue;
    }
    if (pace == Planning::Pace::Calm) {
      if (!calm) options_.clock->restart();
      // Lateness means nothing in virtual time.
      (void)options_.clock->wait_for_cycle();
    }
    calm = pace == Planning::Pace::Calm;
    run_timed(cycle, 0);
  }
}

}  // namespace rmac::gateway
