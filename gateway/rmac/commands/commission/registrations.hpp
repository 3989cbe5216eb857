#pragma once

#include "gateway/rmac/commands/command.hpp"

// What sets a joint up, and shows how well it follows.

namespace rmac::cli {

void add_tune(Command& rmac);
void add_measure_following(Command& rmac);

}  // namespace rmac::cli
