#pragma once

#include <functional>

#include "gateway/rmac/commands.hpp"

namespace CLI {
class App;
}

namespace rmac::cli {

/// What a command of the command line does with the appliance.
using Command = std::function<Result<>(Connection&)>;

/// `measure` and `qualify`. The options are bound to what is given here, which must outlive the parsing and the
/// command.
void add_measuring_commands(CLI::App& app, MeasureRequest& request, QualifyRequest& probe, const bool& json,
                            Command& command);

}  // namespace rmac::cli
