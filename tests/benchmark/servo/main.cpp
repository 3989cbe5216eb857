#include <gtest/gtest.h>

#include "rows.hpp"

int main(int count, char** words) {
  using namespace rmac::bench;
  testing::InitGoogleTest(&count, words);  // the simulated mill checks itself with its assertions
  Figures figures;
  cycle_rows(figures);
  plant_rows(figures);
  circle_rows(figures);
  force_rows(figures);
  disturbance_rows(figures);
  fault_rows(figures);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
