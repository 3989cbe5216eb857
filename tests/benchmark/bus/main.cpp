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
constexpr int kSlave = 1;
constexpr std::size_t kProbe = 3;
constexpr double kGraceMs = 5;

struct Outcome {
  int transactions = 0, accepted = 0, stale = 0;
  std::vector<double> beyond_ms;
};

/// One transaction (connect, resynchronise or read), timed; true where it went well.
template <typename Transaction>
bool timed(Outcome& outcome, Transaction&& transaction) {
  const auto begun = Clock::now();
  const bool fine = transaction();
  const double took_ms = std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
  const double deadline_ms = std::chrono::duration<double, std::milli>(kDeadline).count();
  outcome.beyond_ms.push_back(took_ms - deadline_ms);
  ++outcome.transactions;
  return fine;
}

Outcome run(Wire wire, Manner manner, int transactions) {
  ModbusPeer peer(wire);
  auto client = std::move(*Client::create(peer.endpoint(), kDeadline));
  std::mt19937 random(1);  // NOLINT: the same pauses in every run
  std::array<std::uint16_t, 2> words{};
  Outcome outcome;
  while (outcome.transactions < transactions) {
    // Late around the deadline, so that answers are now in time and now not.
    const int most_us = manner == Manner::Late ? 10'000 : 1'000;
    peer.behave(manner, std::chrono::microseconds(std::uniform_int_distribution(0, most_us)(random)));
    if (!client->connected() && !timed(outcome, [&] { return client->connect().has_value(); })) continue;
    if (client->in_doubt(kSlave) && !timed(outcome, [&] {
          return client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe).has_value();
        })) {
      continue;
    }
    if (!timed(outcome, [&] { return client->read(kSlave, Table::HoldingRegisters, 0, words).has_value(); })) continue;
    ++outcome.accepted;
    if (words[0] != static_cast<std::uint16_t>(peer.requests())) ++outcome.stale;
  }
  return outcome;
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
