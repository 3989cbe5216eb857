#include <cstdio>
#include <cstring>
#include <string>

#include "rows.hpp"

int main(int count, char** words) {
  using namespace rmac::bench;
  Extent extent;
  std::string only;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(words[i], "--quick") == 0) {
      extent.quick = true;
    } else if (std::strcmp(words[i], "--only") == 0 && i + 1 < count) {
      only = words[++i];
    } else {
      std::fprintf(
          stderr, "usage: run [--quick] [--only rose|splines|steps|planning|headlight|interruptions|streams|states]\n");
      return 2;
    }
  }
  struct Row {
    const char* name;
    void (*measure)(Figures&, const Extent&);
  };
  const Row rows[] = {{"rose", rose_rows},         {"splines", spline_rows},       {"steps", curve_step_rows},
                      {"planning", planning_rows}, {"headlight", headlight_rows},  {"interruptions", interruption_rows},
                      {"streams", stream_rows},    {"states", state_to_state_rows}};
  if (extent.quick) std::printf("--quick: fewer cases than the figures are stated for\n");
  Figures figures;
  for (const Row& row : rows) {
    if (only.empty() || only == row.name) row.measure(figures, extent);
  }
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
