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
void force_rows(Figures& figures);
void disturbance_rows(Figures& figures);

}  // namespace rmac::bench
