#include <map>
#include <mutex>
#include <thread>

#include "rows.hpp"
#include "unit/drivers/faults/seeded_fault.hpp"

namespace rmac::bench {

using namespace fault_test;

namespace {

constexpr std::array<const char*, 4> kMachines{"mill/3-axis/DMACXYZ", "mill/4-axis/DMACXYZA", "mill/5-axis/SuginoXYZAC",
                                               "bench/5-axis/TarusXYZCATwin"};

struct Tally {
  unsigned happened = 0, right = 0, in_time = 0, held = 0;
  int slowest_ms = 0;
  double most_gone = 0, most_gone_further = 0;
};

/// What came of all of them, kind by kind; adds from several threads.
class Tallies {
 public:
  void add(Broken broken, const Outcome& outcome) {
    const std::lock_guard lock(mutex_);
    Tally& tally = of_[broken];
    ++all;
    if (outcome.right_cause) ++right;
    if (!outcome.right_cause || !outcome.in_time || !outcome.held) bad.push_back(outcome.told);
    if (broken != Broken::Nothing && !outcome.happened) return;
    ++tally.happened;
    tally.right += outcome.right_cause ? 1 : 0;
    tally.in_time += outcome.in_time ? 1 : 0;
    tally.held += outcome.held ? 1 : 0;
    tally.slowest_ms = std::max(tally.slowest_ms, outcome.noticed_after_ms);
    tally.most_gone = std::max(tally.most_gone, outcome.gone);
    tally.most_gone_further = std::max(tally.most_gone_further, outcome.gone_further);
  }
  [[nodiscard]] const std::map<Broken, Tally>& by_kind() const { return of_; }
  unsigned all = 0, right = 0;
  std::vector<std::string> bad;

 private:
  std::mutex mutex_;
  std::map<Broken, Tally> of_;
};

void run_some(unsigned first, unsigned count, unsigned step, Tallies& tallies) {
  std::vector<std::unique_ptr<TreeMachine>> machines;
  for (const char* const folder : kMachines) machines.push_back(std::make_unique<TreeMachine>(folder));
  for (unsigned i = first; i < first + count; i += step) {
    const auto broken = static_cast<Broken>(i % kBrokenCount);
    tallies.add(broken, SeededFault(*machines[i / kBrokenCount % machines.size()], broken, i).run());
  }
}

double percent(unsigned part, unsigned all) {
  return all == 0 ? 0 : 100.0 * part / all;
}

}  // namespace

void seeded_fault_rows(Figures& figures, const FaultSeeds& seeds) {
  Tallies tallies;
  constexpr unsigned kThreads = 2;
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < kThreads; ++k)
    threads.emplace_back(run_some, seeds.first + k, seeds.count - k, kThreads, std::ref(tallies));
  for (std::thread& thread : threads) thread.join();
  std::sort(tallies.bad.begin(), tallies.bad.end());
  for (const std::string& told : tallies.bad) std::fprintf(stderr, "%s\n", told.c_str());
  Tally sum;
  for (const auto& [kind, tally] : tallies.by_kind()) {
    sum.happened += tally.happened;
    sum.in_time += tally.in_time;
    sum.held += tally.held;
  }
  const std::string of = "of " + std::to_string(tallies.all) + " seeded, on four machines that bend, stick and cog";
  figures.at_least("fault_right_cause", percent(tallies.right, tallies.all), 99.9, "%", of);
  figures.at_least("fault_noticed_in_time", percent(sum.in_time, sum.happened), 99.9, "%", of);
  figures.at_least("fault_stopped_within_way", percent(sum.held, sum.happened), 99.9, "%",
                   of + ", by the load's truth");
  for (const auto& [kind, tally] : tallies.by_kind()) {
    const std::string name = std::string("fault_") + to_string(kind);
    const std::string note = "of " + std::to_string(tally.happened);
    figures.inform(name + "_right_cause", percent(tally.right, tally.happened), "%", note);
    if (kind == Broken::Nothing) continue;
    figures.inform(name + "_in_time", percent(tally.in_time, tally.happened), "%", note);
    figures.inform(name + "_within_way", percent(tally.held, tally.happened), "%", note);
    figures.inform(name + "_noticed_after", tally.slowest_ms, "ms", "the slowest");
    figures.inform(name + "_astray_until_noticed", tally.most_gone, "mm or deg", "the furthest");
    figures.inform(name + "_went_on", tally.most_gone_further, "mm or deg", "the furthest");
  }
}

}  // namespace rmac::bench
