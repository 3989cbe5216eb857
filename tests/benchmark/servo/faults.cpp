#include <map>

#include "rows.hpp"
#include "unit/drivers/faults_on_mill.hpp"

namespace rmac::bench {

using namespace mill_test;

void fault_rows(Figures& figures) {
  constexpr unsigned kFaults = 10'000;
  const std::vector<Injection> kinds = every_injection();
  std::map<Injection, int> slowest;
  unsigned good = 0;
  std::string first_bad;
  for (unsigned seed = 1; seed <= kFaults; ++seed) {
    const Injection kind = kinds[seed % kinds.size()];
    const FaultOutcome outcome = FaultOnMill(seed).run(kind);
    const bool fine = outcome.detected_after > 0 && outcome.fault.stop == outcome.wanted && outcome.stopped;
    slowest[kind] = std::max(slowest[kind], outcome.detected_after);
    if (fine) {
      ++good;
    } else if (first_bad.empty()) {
      first_bad = "; not: seed " + std::to_string(seed) + ", " + outcome.where;
    }
  }
  std::string note = "of 10 000 on the simulated mill";
  figures.at_least("random_faults_detected_and_stopped", good, kFaults, "faults", note + first_bad);
  for (const auto& [kind, cycles] : slowest) {
    figures.inform(std::string("fault_detected_after_") + to_string(kind), cycles, "cycles", "slowest of its kind");
  }
}

}  // namespace rmac::bench
