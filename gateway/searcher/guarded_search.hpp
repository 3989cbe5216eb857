#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Runs a stranger's SQL on a copy of the SQLite file `database` and returns the MechanismID of each row, in the
/// statement's order.
///
/// Nothing in the statement is trusted. Its connection is read-only and defensive; an authorizer lets through SELECT,
/// the columns of DeviceDrivers and a list of harmless functions; lengths, columns, depths and memory are bounded;
/// common tables (WITH) are refused; one statement is taken, and it must yield a MechanismID. An error of
/// InvalidParameterValue tells what was refused. Time is not bounded here: whoever runs it must be able to kill it.
[[nodiscard]] Expected<std::vector<std::int64_t>> search_mechanisms(const std::string& database,
                                                                    const std::string& sql);

}  // namespace rmac::gateway
