#pragma once

#include "gateway/rmac/commands/command.hpp"

// What a person at the machine does: moving it by hand, holding and stopping it, and going back to a parked program.

namespace rmac::cli {

void add_jog(Command& rmac);
void add_home(Command& rmac);
void add_hold(Command& rmac);
void add_resume(Command& rmac);
void add_stop(Command& rmac);
void add_reset(Command& rmac);
void add_parked(Command& rmac);
void add_override(Command& rmac);

}  // namespace rmac::cli
