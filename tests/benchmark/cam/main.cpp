#include "rows.hpp"

int main(int count, char** words) {
  using namespace rmac::bench;
  const Row rows[] = {{"trefoil", trefoil_rows}, {"curves", curve_rows},         {"raster", raster_rows},
                      {"zigzags", zigzag_rows},  {"flow_lines", flow_line_rows}, {"poles", pole_rows},
                      {"nurbs", nurbs_rows},     {"programs", program_rows}};
  return run_rows(count, words, rows, Seeds::AsGiven);
}
