#include "run_rows.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace rmac::bench {
namespace {

int usage(std::span<const Row> rows, Seeds seeds) {
  std::string names;
  for (const Row& row : rows) names += (names.empty() ? "" : "|") + std::string(row.name);
  std::fprintf(stderr, "usage: run [--quick] %s[--only %s]\n", seeds == Seeds::AsGiven ? "[--seed N] " : "",
               names.c_str());
  return 2;
}

}  // namespace

int run_rows(int count, char** words, std::span<const Row> rows, Seeds seeds) {
  Extent extent;
  std::string only;
  for (int i = 1; i < count; ++i) {
    const auto is = [&](const char* option) { return std::strcmp(words[i], option) == 0; };
    if (is("--quick")) {
      extent.quick = true;
    } else if (is("--seed") && seeds == Seeds::AsGiven && i + 1 < count) {
      extent.seed = std::strtoul(words[++i], nullptr, 10);
    } else if (is("--only") && i + 1 < count) {
      only = words[++i];
    } else {
      return usage(rows, seeds);
    }
  }
  if (extent.quick) std::printf("--quick: fewer cases than the figures are stated for\n");
  Figures figures;
  bool any = false;
  for (const Row& row : rows) {
    if (!only.empty() && only != row.name) continue;
    row.measure(figures, extent);
    any = true;
  }
  if (!any) return usage(rows, seeds);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}

}  // namespace rmac::bench
