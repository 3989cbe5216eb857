#include "rows.hpp"

int main(int count, char** words) {
  using namespace rmac::bench;
  const Row rows[] = {{"rose", rose_rows},         {"splines", spline_rows},       {"steps", curve_step_rows},
                      {"planning", planning_rows}, {"headlight", headlight_rows},  {"interruptions", interruption_rows},
                      {"streams", stream_rows},    {"states", state_to_state_rows}};
  return run_rows(count, words, rows, Seeds::AsGiven);
}
