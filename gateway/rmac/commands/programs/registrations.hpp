#pragma once

#include "gateway/rmac/commands/command.hpp"

// Programs: machined, only planned, or made of those of other controls.

namespace rmac::cli {

void add_run(Command& rmac);
void add_simulate(Command& rmac);
void add_import(Command& rmac);

}  // namespace rmac::cli
