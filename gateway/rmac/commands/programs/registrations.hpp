#pragma once

#include "gateway/rmac/commands/command.hpp"

// Programs: machined, or only planned.

namespace rmac::cli {

void add_run(Command& rmac);
void add_simulate(Command& rmac);

}  // namespace rmac::cli
