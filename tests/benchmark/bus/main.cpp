#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "rows.hpp"

// bench_bus [--quick] [--transactions N] [--only deadlines|bits]
int main(int count, char** words) {
  constexpr int kQuickTransactions = 500;
  bool quick = false;
  int transactions = rmac::bench::kWantedTransactions;
  std::string_view only;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--quick") {
      quick = true;
      transactions = kQuickTransactions;
    } else if (word == "--transactions" && i + 1 < count && std::atoi(words[i + 1]) > 0) {
      transactions = std::atoi(words[++i]);
    } else if (word == "--only" && i + 1 < count) {
      only = words[++i];
    } else {
      std::fprintf(stderr, "usage: bench_bus [--quick] [--transactions N] [--only deadlines|bits]\n");
      return 2;
    }
  }
  rmac::bench::Figures figures;
  if (only.empty() || only == "bits") rmac::bench::predicted_bits(figures, quick);
  if (only.empty() || only == "deadlines") rmac::bench::modbus_deadlines(figures, transactions);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
