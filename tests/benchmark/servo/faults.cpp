#include <map>

#include "rows.hpp"
#include "unit/drivers/faults_on_mill.hpp"
#include "unit/drivers/force_on_mill.hpp"

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

void force_rows(Figures& figures) {
  const ForcePass pass = ForceOnMill().press_and_go(
      200, {.surface_mm = -3, .stiffness_n_mm = 1000, .slope = 0.005, .wave_mm = 0.02, .wave_length_mm = 50});
  figures.at_most("contact_force_error", 100 * pass.worst_share, 2, "% of 200 N",
                  "friction-stir-like pass of 40 mm at 600 mm/min, sheet of 1000 N/mm that rises and waves");
  figures.inform("contact_force_settles", 1e3 * pass.settled_s, "ms", "from contact until within 2 %");
  figures.at_most("torque_step_where_force_ends", 100 * pass.release_torque_step, 1, "% of rated",
                  "position control takes over");
}

}  // namespace rmac::bench
