#pragma once

#include "figures.hpp"

namespace rmac::bench {

/// Forward, inverse, forward again, for each mechanism of the device tree.
void inverse_rows(Figures& figures, int poses);
/// The rose with a swinging tool axis on a C-A head, and lines past the pole.
void five_axis_rows(Figures& figures);

}  // namespace rmac::bench
