#pragma once

#include "gateway/rmac/commands/command.hpp"

// What the machine does, and how its cycles keep their time.

namespace rmac::cli {

void add_status(Command& rmac);
void add_cycles(Command& rmac);
void add_events(Command& rmac);

}  // namespace rmac::cli
