#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/device_driver_manager/device_driver_manager.hpp"

namespace rmac::gateway {

/// Has the program rmac-search run a stranger's SQL, and returns the MechanismID of each row, in the statement's order.
/// The program is killed when the limit of `options` is over, wherever in the statement it is. An error tells what was
/// refused. Any thread; blocks.
[[nodiscard]] Expected<std::vector<std::int64_t>> search_mechanisms(const DeviceDriverManager::Options& options,
                                                                    const std::string& sql);

}  // namespace rmac::gateway
