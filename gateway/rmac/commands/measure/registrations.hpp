#pragma once

#include "gateway/rmac/commands/command.hpp"

// Touching parts and spheres with a probe.

namespace rmac::cli {

void add_measure(Command& rmac);
void add_qualify(Command& rmac);

}  // namespace rmac::cli
