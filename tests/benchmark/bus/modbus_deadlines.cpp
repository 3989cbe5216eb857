#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <random>
#include <stdexcept>
#include <thread>

#include "rows.hpp"
#include "unit/fieldbus/modbus/modbus_peer.hpp"

namespace rmac::bench {
namespace {

using namespace rmac::fieldbus::modbus;
using namespace std::chrono_literals;
using Manner = ModbusPeer::Manner;
using Wire = ModbusPeer::Wire;

constexpr auto kDeadline = 5ms;
constexpr std::size_t kProbe = 3;
constexpr double kGraceMs = 5;

struct Outcome {
  int transactions = 0, accepted = 0, stale = 0;
  std::vector<double> beyond_ms;
};

/// How long this thread was ready to run and did not get a processor, so far: the machine's share of any delay.
double waited_for_processor_ms() {
  std::ifstream file("/proc/thread-self/schedstat");
  double ran_ns = 0, waited_ns = 0;
  file >> ran_ns >> waited_ns;
  return waited_ns / 1e6;
}

/// How much longer than the deadline `work` takes, without what the machine adds to that.
template <typename Work>
double beyond_deadline_ms(Work&& work) {
  const double waited_ms = waited_for_processor_ms();
  const auto begun = Clock::now();
  work();
  const double took_ms = std::chrono::duration<double, std::milli>(Clock::now() - begun - kDeadline).count();
  return took_ms - (waited_for_processor_ms() - waited_ms);
}

/// One transaction (connect, resynchronise or read); true where it went well. One that asks nothing does not count.
template <typename Transaction>
bool timed(Outcome& outcome, Transaction&& transaction) {
  Answer<> answer;
  const double beyond = beyond_deadline_ms([&] { answer = transaction(); });
  if (!answer && answer.error().kind == Failure::Kind::InDoubt) {
    poll(nullptr, 0, 1);
    return false;
  }
  outcome.beyond_ms.push_back(beyond);
  ++outcome.transactions;
  return answer.has_value();
}

Outcome run(Wire wire, Manner manner, int transactions) {
  ModbusPeer peer(wire);
  auto client = std::move(*Client::create(peer.endpoint(), kDeadline));
  std::mt19937 random(1);  // NOLINT: the same pauses in every run
  std::array<std::uint16_t, 2> words{};
  Outcome outcome;
  // A client asks one slave that it doubts a few times a second, so there are many; but not where they queue up.
  const int slaves = manner == Manner::Late ? 1 : 100;
  for (int turn = 0; outcome.transactions < transactions; ++turn) {
    const int slave = 1 + 2 * (turn % slaves);
    // Late around the deadline, so that answers are now in time and now not.
    const int most_us = manner == Manner::Late ? 10'000 : 1'000;
    peer.behave(manner, std::chrono::microseconds(std::uniform_int_distribution(0, most_us)(random)));
    if (!client->connected() && !timed(outcome, [&] { return client->connect(); })) continue;
    if (client->in_doubt(slave) &&
        !timed(outcome, [&] { return client->resynchronise(slave, Table::HoldingRegisters, 0, kProbe); })) {
      continue;
    }
    if (!timed(outcome,
               [&] { return client->read(slave, Table::HoldingRegisters, 0, words).map([](Clock::time_point) {}); })) {
      continue;
    }
    ++outcome.accepted;
    if (words[0] != static_cast<std::uint16_t>(peer.requests())) ++outcome.stale;
  }
  return outcome;
}

/// Another thread, which does nothing but wait for a timer again and again while the transactions run: how late this
/// machine wakes up whoever waits. Beside a serial line it waits at a pseudo-terminal of its own into which bytes drip,
/// because there the kernel lets nobody go on before a worker of its own has carried the bytes, timer or not.
class Beside {
 public:
  explicit Beside(Wire wire) {
    if (wire == Wire::Rtu) {
      end_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
      std::array<char, 64> name{};
      if (end_ < 0 || grantpt(end_) != 0 || unlockpt(end_) != 0 || ptsname_r(end_, name.data(), name.size()) != 0) {
        throw std::runtime_error("no pseudo-terminal");
      }
      line_ = open(name.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
      termios raw{};
      tcgetattr(line_, &raw);
      cfmakeraw(&raw);
      tcsetattr(line_, TCSANOW, &raw);
      drip_ = std::thread([this] { drip(); });
    }
    wait_ = std::thread([this] { wait(); });
  }
  ~Beside() {
    ends_ = true;
    wait_.join();
    if (drip_.joinable()) drip_.join();
    for (const int descriptor : {end_, line_}) {
      if (descriptor >= 0) close(descriptor);
    }
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  [[nodiscard]] double latest_ms() const noexcept { return latest_ms_; }

 private:
  void wait() {
    while (!ends_) latest_ms_ = std::max<double>(latest_ms_, beyond_deadline_ms([this] { until_deadline(); }));
  }
  void until_deadline() const {
    const auto until = Clock::now() + kDeadline;
    pollfd line{line_, POLLIN, 0};
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
      if (left <= 0 || poll(&line, 1, static_cast<int>(left)) == 0) return;
      char byte = 0;
      while (read(line_, &byte, 1) > 0) {
      }
    }
  }
  void drip() const {
    std::mt19937 random(1);  // NOLINT: the same pauses in every run
    while (!ends_) {
      const timespec pause{0, std::uniform_int_distribution(0, 1'000'000)(random)};
      ppoll(nullptr, 0, &pause, nullptr);
      static_cast<void>(!write(end_, "x", 1));
    }
  }

  int end_ = -1, line_ = -1;
  std::atomic<bool> ends_{false};
  std::atomic<double> latest_ms_{0};
  std::thread drip_, wait_;
};

}  // namespace

void modbus_deadlines(Figures& figures, int transactions) {
  const std::array<std::pair<Manner, const char*>, 6> manners{{{Manner::Silent, "silent"},
                                                               {Manner::Dripping, "dripping"},
                                                               {Manner::Late, "late"},
                                                               {Manner::WrongId, "wrong_id"},
                                                               {Manner::Resetting, "resetting"},
                                                               {Manner::Garbage, "garbage"}}};
  for (const Wire wire : {Wire::Tcp, Wire::Rtu}) {
    for (const auto& [manner, name] : manners) {
      const Beside beside(wire);
      const Outcome outcome = run(wire, manner, transactions);
      const std::string who = std::string("modbus_") + (wire == Wire::Tcp ? "tcp_" : "rtu_") + name;
      const std::string note = std::to_string(outcome.transactions) + " transactions, " +
                               std::to_string(outcome.accepted) + " reads accepted" +
                               (transactions < kWantedTransactions ? "; 10000 wanted" : "");
      figures.at_most(who + "_beyond_deadline_max", quantile(outcome.beyond_ms, 1), kGraceMs, "ms", note);
      figures.inform(who + "_beyond_deadline_p999", quantile(outcome.beyond_ms, 0.999), "ms");
      figures.inform(who + "_beside_max", beside.latest_ms(), "ms",
                     wire == Wire::Rtu ? "a wait at another pseudo-terminal meanwhile, without Modbus in it"
                                       : "a wait of another thread meanwhile, without Modbus in it");
      figures.at_most(who + "_stale_taken", outcome.stale, 0, "values", note);
    }
  }
}

}  // namespace rmac::bench
