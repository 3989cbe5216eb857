#pragma once

#include "../motion/figures.hpp"

namespace rmac::bench {

struct Extent {
  bool quick = false;  ///< fewer cases
  unsigned long seed = 1;
  [[nodiscard]] int cases(int full, int few) const { return quick ? few : full; }
};

void trefoil_rows(Figures& figures, const Extent& extent);
void curve_rows(Figures& figures, const Extent& extent);

}  // namespace rmac::bench
