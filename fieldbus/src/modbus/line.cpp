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
constexpr std::chrono::seconds kSafePatience{3};  ///< with a device that is busy just then

// Whoever asks why a drive was silent may ask when it has answered again.
constexpr std::chrono::seconds kRemembered{10};

/// What a device does that gives nothing.
const char* manner(const Failure& failure) noexcept {
  switch (failure.kind) {
    case Failure::Kind::WrongAnswer:
      return "is not understood";
    case Failure::Kind::Exception:
      return failure.busy() ? "is busy" : "refuses";
    default:
      return "does not answer";
  }
}

}  // namespace

struct Line::Impl {
  /// What is known of a station, for whoever waits in `start` or asks for its trouble. Under the lock.
  struct Known {
    bool served = false;  ///< once
    bool works = true;    ///< the last time
    Failure trouble{Failure::Kind::NotConnected, 0, "the line was not opened yet"};
    std::optional<Clock::time_point> troubled{};  ///< last
  };

  LineConfig config;
  std::vector<Station*> stations;
  std::unique_ptr<Client> client{};
  int wakeup = -1;
  std::atomic<bool> ending{false};
  std::atomic<std::uint64_t> rounds{0}, failures{0}, connected{0};
  std::atomic<std::uint64_t> timeouts{0}, wrong_answers{0}, busy{0}, exceptions{0}, disconnects{0};
  std::mutex mutex{};
  std::condition_variable news{};
  std::vector<Known> known{};
  std::size_t first = 0;  ///< station of the next round; line's thread
  bool broke = true;      ///< the line was not open, or failed as a whole, since stations were told; line's thread
  bool tried = false;     ///< a first round has ended, under the lock
  std::thread thread{};

  void run() {
    Backoff backoff(config.first_pause, config.longest_pause);
    while (!ending) {
      const auto begun = config.now();
      if (client->connected() || (backoff.due(begun) && open(backoff))) {
        // To be opened proves nothing: only a device that answers ends the pauses.
        if (serve_all()) {
          backoff.succeeded();
        } else if (!client->connected()) {
          backoff.failed(config.now());
        }
      }
      ++rounds;
      note_round();
      pause(begun + config.period);
    }
    finish();
  }

  bool open(Backoff& backoff) {
    const auto opened = connect();
    if (!opened) {
      backoff.failed(config.now());
      for (std::size_t i = 0; i < stations.size(); ++i) note(i, opened);
      return false;
    }
    if (std::exchange(broke, false)) {
      for (Station* station : stations) station->forget();
    }
    return true;
  }

  Answer<> connect() {
    auto opened = client->connect();
    if (opened) {
      ++connected;
    } else {
      count(opened.error());
      broke = true;
    }
    return opened;
  }

  /// On TCP an answer that a slave lost takes the connection with it (see `Client`): the others behind the same gateway
  /// are served over the next one. A line that broke waits for its pause.
  [[nodiscard]] bool stands() { return client->connected() || (!broke && connect()); }

  /// True when at least one was served.
  bool serve_all() {
    bool any = false;
    std::size_t next = first;
    for (std::size_t i = 0; i < stations.size() && stands(); ++i) {
      const std::size_t station = (first + i) % stations.size();
      const auto served = stations[station]->serve(*client);
      any = any || served.has_value();
      if (!served) {
        ++failures;
        count(served.error());
        broke = broke || served.error().kind == Failure::Kind::Disconnected;
        stations[station]->forget();
      }
      note(station, served);
      // Where the gateway does not take the next connection at once, the one behind has the first turn on that.
      if (!client->connected()) next = (station + 1) % stations.size();
    }
    first = next;
    return any;
  }

  void count(const Failure& failure) noexcept {
    switch (failure.kind) {
      case Failure::Kind::Timeout:
        ++timeouts;
        break;
      case Failure::Kind::WrongAnswer:
        ++wrong_answers;
        break;
      case Failure::Kind::Exception:
        ++(failure.busy() ? busy : exceptions);
        break;
      case Failure::Kind::Disconnected:
        ++disconnects;
        break;
      case Failure::Kind::BadRequest:
      case Failure::Kind::NotConnected:
      case Failure::Kind::InDoubt:  // what follows from one of the others
        break;
    }
  }

  void note(std::size_t station, const Answer<>& served) {
    const std::lock_guard lock(mutex);
    Known& of = known[station];
    if (!served) {
      // Doubt follows from an answer that was lost, and says nothing of why.
      const bool follows = served.error().kind == Failure::Kind::InDoubt && of.troubled && !of.works;
      if (!follows) of.trouble = served.error();
      of.troubled = config.now();
    }
    of.works = served.has_value();
    of.served = of.served || of.works;
    news.notify_all();
  }

  void note_round() {
    const std::lock_guard lock(mutex);
    if (!std::exchange(tried, true)) news.notify_all();
  }

  /// Until then, or until woken.
  void pause(Clock::time_point until) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - config.now());
    pollfd wanted{wakeup, POLLIN, 0};
    if (poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) > 0) {
      std::uint64_t count = 0;
      static_cast<void>(!read(wakeup, &count, sizeof(count)));
    }
  }

  void finish() {
    const auto patient_until = config.now() + kSafePatience;
    for (int tries = 0; tries < kSafeTries; ++tries) {
      bool all = true, one_busy = false;
      for (Station* station : stations) {
        if (!client->connected() && !client->connect()) {
          all = false;
          break;
        }
        const auto safe = station->make_safe(*client);
        all = all && safe;
        one_busy = one_busy || (!safe && safe.error().busy());
      }
      if (all) break;
      if (!one_busy || config.now() >= patient_until) continue;
      pause(config.now() + config.period);
      tries = -1;  // a device that answers is worth the wait
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
  auto client = Client::create(line.config.endpoint, line.config.deadline, line.config.now);
  if (!client) return tl::unexpected(client.error());
  line.client = std::move(*client);
  {
    const std::lock_guard lock(line.mutex);  // of someone who asks for the trouble of the last run
    line.known.assign(line.stations.size(), {});
    line.tried = false;
  }
  for (auto* counter : {&line.rounds, &line.failures, &line.connected, &line.timeouts, &line.wrong_answers, &line.busy,
                        &line.exceptions, &line.disconnects})
    *counter = 0;
  line.ending = false;
  line.broke = true;
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
    const std::string trouble = line.known[i].trouble.message;
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
  return {impl_->rounds,        impl_->failures, impl_->connected,  impl_->timeouts,
          impl_->wrong_answers, impl_->busy,     impl_->exceptions, impl_->disconnects};
}

LineReport Line::report() const {
  LineReport told{to_string(impl_->config.endpoint), impl_->rounds, impl_->connected, {}};
  for (std::size_t i = 0; i < impl_->stations.size(); ++i) {
    UnitReport& unit = told.units.emplace_back(UnitReport{impl_->stations[i]->slave(), "off", {}});
    if (!impl_->client) continue;
    unit.traffic = impl_->client->traffic(unit.unit);
    const std::lock_guard lock(impl_->mutex);
    const Impl::Known& of = impl_->known[i];
    unit.state = of.works ? "answers" : manner(of.trouble);
  }
  return told;
}

std::optional<std::string> Line::trouble(std::size_t station) const {
  std::string text;
  {
    const std::lock_guard lock(impl_->mutex);
    if (station >= impl_->known.size()) return {};
    const Impl::Known& of = impl_->known[station];
    if (!of.troubled || (of.works && impl_->config.now() - *of.troubled > kRemembered)) return {};
    text = fmt::format("{}: {}", manner(of.trouble), of.trouble.message);
  }
  const LineCounters seen = counters();
  return fmt::format(
      "{} (since the start {} time-outs, {} wrong answers, {} times busy, {} other exceptions, {} disconnects)", text,
      seen.timeouts, seen.wrong_answers, seen.busy, seen.exceptions, seen.disconnects);
}

}  // namespace rmac::fieldbus::modbus
