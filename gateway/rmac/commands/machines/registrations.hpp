#pragma once

#include "gateway/rmac/commands/command.hpp"

// Which machines there are, what they are, and which one is loaded.

namespace rmac::cli {

void add_machines(Command& rmac);
void add_show(Command& rmac);
void add_load(Command& rmac);
void add_unload(Command& rmac);
void add_verify(Command& rmac);

}  // namespace rmac::cli
