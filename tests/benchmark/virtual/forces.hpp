#pragma once

#include "benchmark/motion/figures.hpp"

namespace rmac::bench {

/// Milling forces against a sum over short pieces of edge, and how long a turn takes.
void measure_forces(Figures& figures);

}  // namespace rmac::bench
