#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// What a program that came to its end said.
struct ChildOutcome {
  int exit_code = 0;      ///< negative: the signal that ended it
  std::string output;     ///< standard output
  std::string complaint;  ///< standard error
};

/// Runs a program to its end, with nothing of this process open in it; the first of `words` is its path. Killed, with
/// what it started in its process group, when it takes longer than `patience`, or soon after `cancelled` is set.
/// Blocks.
[[nodiscard]] Expected<ChildOutcome> run_child(const std::vector<std::string>& words,
                                               std::chrono::milliseconds patience, const std::atomic<bool>& cancelled);

}  // namespace rmac::gateway
