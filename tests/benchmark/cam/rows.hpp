#pragma once

#include "../motion/run_rows.hpp"

namespace rmac::bench {

void trefoil_rows(Figures& figures, const Extent& extent);
void curve_rows(Figures& figures, const Extent& extent);
void raster_rows(Figures& figures, const Extent& extent);
void zigzag_rows(Figures& figures, const Extent& extent);
void flow_line_rows(Figures& figures, const Extent& extent);
void pole_rows(Figures& figures, const Extent& extent);
void nurbs_rows(Figures& figures, const Extent& extent);
void program_rows(Figures& figures, const Extent& extent);

}  // namespace rmac::bench
