#pragma once

#include "gateway/rmac/commands/command.hpp"

// Flight records: listed, made, fetched, drawn.

namespace rmac::cli {

void add_trace(Command& rmac);

}  // namespace rmac::cli
