#include <cstdio>
#include <cstdlib>
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
    } else if (std::strcmp(words[i], "--seed") == 0 && i + 1 < count) {
      extent.seed = std::strtoul(words[++i], nullptr, 10);
    } else if (std::strcmp(words[i], "--only") == 0 && i + 1 < count) {
      only = words[++i];
    } else {
      std::fprintf(stderr, "usage: run [--quick] [--seed N] [--only trefoil|curves]\n");
      return 2;
    }
  }
  struct Row {
    const char* name;
    void (*measure)(Figures&, const Extent&);
  };
  const Row rows[] = {{"trefoil", trefoil_rows}, {"curves", curve_rows}};
  if (extent.quick) std::printf("--quick: fewer cases than the figures are stated for\n");
  Figures figures;
  for (const Row& row : rows) {
    if (only.empty() || only == row.name) row.measure(figures, extent);
  }
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
