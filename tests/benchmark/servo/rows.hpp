#pragma once

#include "figures.hpp"

namespace rmac::bench {

/// Time and allocations of one cycle.
void cycle_rows(Figures& figures);
/// Time that a simulated axis takes.
void plant_rows(Figures& figures);
/// A circle on the simulated mill, law by law, and laws that change meanwhile.
void circle_rows(Figures& figures);
void fault_rows(Figures& figures);
/// Which of the seeded faults are run.
struct FaultSeeds {
  unsigned first = 1;
  unsigned count = 10'000;
};
/// Faults of encoders, motors, loops and ways, judged by the plant: is the cause named, in time, and how far it goes.
void seeded_fault_rows(Figures& figures, const FaultSeeds& seeds);
void force_rows(Figures& figures);
void disturbance_rows(Figures& figures);

}  // namespace rmac::bench
