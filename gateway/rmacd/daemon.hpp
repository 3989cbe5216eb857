#pragma once

#include "gateway/configuration/configuration.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Runs the appliance until SIGTERM, SIGINT or SIGHUP asks it to end, which it does at standstill. The error says what
/// did not start.
[[nodiscard]] Expected<> run_daemon(const Configuration& configuration);

}  // namespace rmac::gateway
