#include "rmac/fieldbus/modbus/line.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "rmac/fieldbus/modbus/backoff.hpp"

namespace rmac::fieldbus::modbus {
namespace {

constexpr int kSafeTries = 3;

}  // namespace

struct Line::Impl {
  /// What is known of a station, for whoever waits in `start`. Under the lock.
  struct Known {
    bool served = false;
    std::string trouble = "the line was not opened yet";
  };

  LineConfig config;
  std::vector<Station*> stations;
  std::unique_ptr<Client> client{};
  int wakeup = -1;
  std::atomic<bool> ending{false};
  std::atomic<std::uint64_t> rounds{0}, failures{0}, connected{0};
  std::mutex mutex{};
  std::condition_variable news{};
  std::vector<Known> known{};
  bool tried = false;  ///< a first round has ended, under the lock
  std::thread thread{};

  void run() {
    Backoff backoff(config.first_pause, config.longest_pause);
    while (!ending) {
      const auto begun = Clock::now();
      if (client->connected() || (backoff.due(begun) && open(backoff))) {
        // To be opened proves nothing: only a device that answers ends the pauses.
        if (serve_all()) {
          backoff.succeeded();
        } else if (!client->connected()) {
          backoff.failed(Clock::now());
        }
      }
      ++rounds;
      note_round();
      pause(begun + config.period);
    }
    finish();
  }

  bool open(Backoff& backoff) {
    const auto opened = client->connect();
    if (!opened) {
      backoff.failed(Clock::now());
      for (std::size_t i = 0; i < stations.size(); ++i) note(i, opened);
      return false;
    }
    ++connected;
    for (Station* station : stations) station->forget();
    return true;
  }

  /// True when at least one was served.
  bool serve_all() {
    bool any = false;
    for (std::size_t i = 0; i < stations.size() && client->connected(); ++i) {
      const auto served = stations[i]->serve(*client);
      any = any || served.has_value();
      if (!served) {
        ++failures;
        stations[i]->forget();
      }
      note(i, served);
    }
    return any;
  }

  void note(std::size_t station, const Answer<>& served) {
    const std::lock_guard lock(mutex);
    known[station].served = known[station].served || served.has_value();
    if (!served) known[station].trouble = served.error().message;
    news.notify_all();
  }

  void note_round() {
    const std::lock_guard lock(mutex);
    if (!std::exchange(tried, true)) news.notify_all();
  }

  /// Until then, or until woken.
  void pause(Clock::time_point until) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd wanted{wakeup, POLLIN, 0};
    if (poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) > 0) {
      std::uint64_t count = 0;
      static_cast<void>(!read(wakeup, &count, sizeof(count)));
    }
  }

  void finish() {
    for (int tries = 0; tries < kSafeTries; ++tries) {
      if (!client->connected() && !client->connect()) continue;
      bool all = true;
      for (Station* station : stations) all = station->make_safe(*client).has_value() && all;
      if (all) break;
    }
    client->disconnect();
  }
};

Line::Line(LineConfig config, std::vector<Station*> stations)
    : impl_(new Impl{std::move(config), std::move(stations)}) {
  impl_->wakeup = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
}

Line::~Line() {
  stop();
  if (impl_->wakeup >= 0) close(impl_->wakeup);
}

Expected<> Line::start(std::chrono::milliseconds patience) {
  Impl& line = *impl_;
  stop();
  if (line.wakeup < 0) return failure(MinorCode::Other, "no more file descriptors");
  auto client = Client::create(line.config.endpoint, line.config.deadline);
  if (!client) return tl::unexpected(client.error());
  line.client = std::move(*client);
  line.known.assign(line.stations.size(), {});
  line.tried = false;
  line.ending = false;
  line.thread = std::thread([&line] { line.run(); });
  std::unique_lock lock(line.mutex);
  const auto all_served = [&] {
    return std::all_of(line.known.begin(), line.known.end(), [](const Impl::Known& one) { return one.served; });
  };
  // A busy computer may not even have begun by then: a first round, which the deadline bounds, says what is wrong.
  if (line.news.wait_for(lock, patience, all_served)) return {};
  line.news.wait(lock, [&] { return line.tried; });
  if (all_served()) return {};
  for (std::size_t i = 0; i < line.known.size(); ++i) {
    if (line.known[i].served) continue;
    const int slave = line.stations[i]->slave();
    const std::string trouble = line.known[i].trouble;
    lock.unlock();
    stop();
    return failure(MinorCode::CommTimeout, fmt::format("slave {} at {} was not reached within {:g} s: {}", slave,
                                                       to_string(line.config.endpoint),
                                                       std::chrono::duration<double>(patience).count(), trouble));
  }
  return {};
}

void Line::stop() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->ending = true;
  wake();
  impl_->thread.join();
}

void Line::wake() noexcept {
  const std::uint64_t one = 1;
  static_cast<void>(!write(impl_->wakeup, &one, sizeof(one)));
}

LineCounters Line::counters() const noexcept {
  return {impl_->rounds, impl_->failures, impl_->connected};
}

}  // namespace rmac::fieldbus::modbus
