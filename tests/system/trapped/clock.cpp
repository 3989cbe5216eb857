// The clock of the trapped daemon. At its end the daemon says what the trap caught, as a line of JSON on stderr.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "trapping_clock.hpp"

namespace rmac::gateway {

std::shared_ptr<Clock> make_own_clock(double period_s);

namespace {

/// What is shown here does not depend on how long a cycle waits for the next.
constexpr double kTimesAsFast = 6;

std::shared_ptr<TrappingClock> clock_in_use;
verifier::TrapCounts caught;

/// What the thread does after its last cycle, as it ends, is none of a cycle's.
void keep_what_was_caught() {
  if (!verifier::trap_caught()) return;
  const verifier::TrapCounts found = verifier::take_trap_counts();
  if (caught.first.empty()) caught.first = found.first;
  caught.allocations += found.allocations;
  caught.locks += found.locks;
  caught.system_calls += found.system_calls;
}

struct AtTheEnd {
  ~AtTheEnd() {
    if (!clock_in_use) return;
    const nlohmann::json told{{"cycles", clock_in_use->cycles()},
                              {"allocations", caught.allocations},
                              {"locks", caught.locks},
                              {"system_calls", caught.system_calls},
                              {"catches_system_calls", clock_in_use->catches_system_calls()},
                              {"first", caught.first}};
    fmt::print(stderr, "trap: {}\n", told.dump());
  }
};

const AtTheEnd at_the_end;

}  // namespace

std::shared_ptr<Clock> make_monotonic_clock(double period_s) {
  clock_in_use = std::make_shared<TrappingClock>(make_own_clock(period_s / kTimesAsFast), keep_what_was_caught);
  return clock_in_use;
}

}  // namespace rmac::gateway
