#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "rows.hpp"

namespace {

int usage() {
  std::fputs(
      "bench_servo [--faults [--seed N] [--count N]]\n"
      "  --faults   the seeded faults alone; those that are not as promised are told, with their seed, on stderr\n"
      "  --seed N   the first of them (1)\n"
      "  --count N  how many (10000)\n",
      stderr);
  return 2;
}

}  // namespace

int main(int count, char** words) {
  using namespace rmac::bench;
  testing::InitGoogleTest(&count, words);  // the simulated mill checks itself with its assertions
  FaultSeeds seeds;
  bool faults_alone = false;
  for (int i = 1; i < count; ++i) {
    const bool has_number = i + 1 < count && std::atoi(words[i + 1]) > 0;
    if (std::strcmp(words[i], "--faults") == 0) {
      faults_alone = true;
    } else if (has_number && std::strcmp(words[i], "--seed") == 0) {
      seeds.first = static_cast<unsigned>(std::atoi(words[++i]));
    } else if (has_number && std::strcmp(words[i], "--count") == 0) {
      seeds.count = static_cast<unsigned>(std::atoi(words[++i]));
    } else {
      return usage();
    }
  }
  Figures figures;
  if (!faults_alone) {
    cycle_rows(figures);
    plant_rows(figures);
    circle_rows(figures);
    force_rows(figures);
    disturbance_rows(figures);
    fault_rows(figures);
  }
  seeded_fault_rows(figures, seeds);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
