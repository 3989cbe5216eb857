#include <cstring>

#include "rows.hpp"

int main(int count, char** words) {
  using namespace rmac::bench;
  const bool quick = count > 1 && std::strcmp(words[1], "--quick") == 0;
  Figures figures;
  inverse_rows(figures, quick ? 10'000 : 1'000'000);
  five_axis_rows(figures);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
