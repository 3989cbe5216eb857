#pragma once

#include <span>

#include "gateway/rmac/commands/command.hpp"

namespace rmac::cli {

/// Parses the words of a command line, the program's name first, and carries out the command that they name. What goes
/// wrong is told on standard error; the exit code says whether the words were wrong or the command failed.
[[nodiscard]] int carry_out(std::span<const Registration> commands, int count, const char* const* words);

}  // namespace rmac::cli
