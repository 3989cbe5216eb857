#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "gateway/bodies/body.hpp"
#include "gateway/rmac/program/program.hpp"

namespace rmac::cli {

/// What a machine makes of a program.
struct Fit {
  bool fits = false;
  double cycle_time_s = 0;  ///< where it fits
  std::optional<double>
      spindle_used{};     ///< there: the most that cutting took of what the spindle has; where it is known
  std::string why_not{};  ///< where it does not: what was refused, in which line, and what to do
};

/// What is asked of each machine.
struct FitQuestion {
  Program program;  ///< machines that it would load are passed over: which one it runs on is the question
  std::filesystem::path device_tree;  ///< empty: the installation's
  std::filesystem::path tools;        ///< folder of tool tables, or empty
  std::filesystem::path setup_file;   ///< what is clamped; empty: nothing
  std::filesystem::path materials;    ///< the work materials that are known; empty: the installation's
};

/// Where a set-up for one machine puts its part on another: as far from the middle of the table's top. Its part frame
/// stays as it is where one of the tables is not known.
[[nodiscard]] Frame part_frame_on(const gateway::MachineBodies& own, const gateway::MachineBodies& other,
                                  const Frame& part_frame);

/// Plans the program on a machine of the device tree as `rmac simulate` does. With a set-up, which stands on each table
/// as on its own, what meets, what cannot be checked, and what the spindle has not enough for, do not fit.
[[nodiscard]] Fit fit_of(const FitQuestion& question, const std::string& machine);

}  // namespace rmac::cli
