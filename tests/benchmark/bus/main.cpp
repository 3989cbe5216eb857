#include <poll.h>

#include <fstream>
#include <random>
#include <string_view>

#include "figures.hpp"
#include "unit/fieldbus/modbus_peer.hpp"

namespace {

using namespace rmac::bench;
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

/// How late a wait of the deadline's length ends here and now, without any Modbus in it.
std::vector<double> plain_waits_beyond_ms(int waits) {
  std::vector<double> beyond;
  for (int i = 0; i < waits; ++i) {
    beyond.push_back(beyond_deadline_ms([] { poll(nullptr, 0, static_cast<int>(kDeadline.count())); }));
  }
  return beyond;
}

}  // namespace

int main(int count, char** words) {
  const bool quick = count > 1 && std::string_view(words[1]) == "--quick";
  const int transactions = quick ? 500 : 10'000;
  Figures figures;
  const std::array<std::pair<Manner, const char*>, 6> manners{{{Manner::Silent, "silent"},
                                                               {Manner::Dripping, "dripping"},
                                                               {Manner::Late, "late"},
                                                               {Manner::WrongId, "wrong_id"},
                                                               {Manner::Resetting, "resetting"},
                                                               {Manner::Garbage, "garbage"}}};
  const std::vector<double> plain = plain_waits_beyond_ms(transactions);
  figures.inform("plain_wait_beyond_deadline_max", quantile(plain, 1), "ms", "a wait without Modbus in it");
  figures.inform("plain_wait_beyond_deadline_p999", quantile(plain, 0.999), "ms");
  for (const Wire wire : {Wire::Tcp, Wire::Rtu}) {
    for (const auto& [manner, name] : manners) {
      const Outcome outcome = run(wire, manner, transactions);
      const std::string who = std::string("modbus_") + (wire == Wire::Tcp ? "tcp_" : "rtu_") + name;
      const std::string note = std::to_string(outcome.transactions) + " transactions, " +
                               std::to_string(outcome.accepted) + " reads accepted" +
                               (quick ? "; quick, 10000 wanted" : "");
      figures.at_most(who + "_beyond_deadline_max", quantile(outcome.beyond_ms, 1), kGraceMs, "ms", note);
      figures.inform(who + "_beyond_deadline_p999", quantile(outcome.beyond_ms, 0.999), "ms");
      figures.at_most(who + "_stale_taken", outcome.stale, 0, "values", note);
    }
  }
  constexpr const char* kBench = "not measured: needs the virtual bench";
  figures.missing("missed_cycles_3_axes_1khz_10min", "<= 0", "cycles", kBench);
  figures.missing("missed_cycles_6_axes_500hz_10min", "<= 0", "cycles", kBench);
  figures.missing("sync_jitter_p999_above_cyclictest", "<= 50", "us", kBench);
  figures.missing("adapter_swaps_without_sync_gap", ">= 1000", "swaps", kBench);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
