#pragma once

#include "gateway/rmac/commands/command.hpp"

// The tool table, and what is in the spindle.

namespace rmac::cli {

void add_tools(Command& rmac);
void add_confirm(Command& rmac);

}  // namespace rmac::cli
