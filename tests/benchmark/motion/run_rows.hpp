#pragma once

#include <span>

#include "figures.hpp"

namespace rmac::bench {

/// How much is measured, and of what.
struct Extent {
  bool quick = false;      ///< fewer cases
  unsigned long seed = 1;  ///< of a bench that takes one
  [[nodiscard]] int cases(int full, int few) const { return quick ? few : full; }
};

/// A part of a bench.
struct Row {
  const char* name;
  void (*measure)(Figures&, const Extent&);
};

enum class Seeds { One, AsGiven };

/// The bench of these rows, or of one of them, as the command line says; its exit code.
int run_rows(int count, char** words, std::span<const Row> rows, Seeds seeds);

}  // namespace rmac::bench
