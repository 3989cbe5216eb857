#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "rows.hpp"

namespace {

int usage() {
  std::fputs(
      "bench_servo [--only ROWS | --faults [--seed N] [--count N]]\n"
      "  --only     these rows alone: cycle, plant, circle, force, disturbance, fault\n"
      "  --faults   the seeded faults alone; those that are not as promised are told, with their seed, on stderr\n"
      "  --seed N   the first of them (1)\n"
      "  --count N  how many (10000)\n",
      stderr);
  return 2;
}

struct Rows {
  std::string_view name;
  void (*measure)(rmac::bench::Figures&);
};
constexpr std::array kRows{Rows{"cycle", rmac::bench::cycle_rows},
                           Rows{"plant", rmac::bench::plant_rows},
                           Rows{"circle", rmac::bench::circle_rows},
                           Rows{"force", rmac::bench::force_rows},
                           Rows{"disturbance", rmac::bench::disturbance_rows},
                           Rows{"fault", rmac::bench::fault_rows}};

}  // namespace

int main(int count, char** words) {
  using namespace rmac::bench;
  testing::InitGoogleTest(&count, words);  // the simulated mill checks itself with its assertions
  FaultSeeds seeds;
  bool faults_alone = false;
  const Rows* only = nullptr;
  for (int i = 1; i < count; ++i) {
    const bool has_number = i + 1 < count && std::atoi(words[i + 1]) > 0;
    if (std::strcmp(words[i], "--faults") == 0) {
      faults_alone = true;
    } else if (i + 1 < count && std::strcmp(words[i], "--only") == 0) {
      only = std::ranges::find(kRows, std::string_view(words[++i]), &Rows::name);
      if (only == kRows.end()) return usage();
    } else if (has_number && std::strcmp(words[i], "--seed") == 0) {
      seeds.first = static_cast<unsigned>(std::atoi(words[++i]));
    } else if (has_number && std::strcmp(words[i], "--count") == 0) {
      seeds.count = static_cast<unsigned>(std::atoi(words[++i]));
    } else {
      return usage();
    }
  }
  Figures figures;
  for (const Rows& rows : kRows) {
    if (only ? only == &rows : !faults_alone) rows.measure(figures);
  }
  if (!only) seeded_fault_rows(figures, seeds);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
