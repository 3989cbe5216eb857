#pragma once

#include <filesystem>
#include <string>

#include "gateway/rmac/program/program.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What a machine makes of a program.
struct Fit {
  bool fits = false;
  double cycle_time_s = 0;  ///< where it fits
  std::string why_not;      ///< where it does not: what was refused, in which line, and what to do
};

/// Plans the program on a machine of the device tree as `rmac simulate` does. Machines that the program itself would
/// load are passed over: which one it runs on is the question. `tools`: folder of tool tables, or empty.
[[nodiscard]] Fit fit_of(const Program& program, const std::string& machine, const std::filesystem::path& device_tree,
                         const std::filesystem::path& tools);

}  // namespace rmac::cli
