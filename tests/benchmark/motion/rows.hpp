#pragma once

#include "run_rows.hpp"

namespace rmac::bench {

void rose_rows(Figures& figures, const Extent& extent);
void spline_rows(Figures& figures, const Extent& extent);
void curve_step_rows(Figures& figures, const Extent& extent);
void planning_rows(Figures& figures, const Extent& extent);
void interruption_rows(Figures& figures, const Extent& extent);
void headlight_rows(Figures& figures, const Extent& extent);
void stream_rows(Figures& figures, const Extent& extent);
void state_to_state_rows(Figures& figures, const Extent& extent);

}  // namespace rmac::bench
