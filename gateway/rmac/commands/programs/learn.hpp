#pragma once

#include <string>

#include "gateway/rmac/program/program.hpp"
#include "gateway/rmac/program/runner.hpp"
#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

struct LearnOptions {
  int passes = 0;            ///< 0: nothing is to be learned
  double bandwidth_hz = 20;  ///< up to which it is learned: about that of the slowest loop
  bool use = false;          ///< what was learned before is to be made good
  std::string file;          ///< where that is; empty: the program's name with .learned behind it
};

/// Runs a program several times, learns from each pass for the next one, tells how it went, and writes down what made
/// the best of them.
[[nodiscard]] Result<> learn_program(Connection& connection, const Program& program, const RunOptions& run,
                                     const LearnOptions& options, bool json);

/// What was learned of this program, as the appliance takes it; refused where the program is another one.
[[nodiscard]] Result<nlohmann::json> learned_of(const Program& program, const LearnOptions& options);

}  // namespace rmac::cli
