#pragma once

#include "gateway/modules/module_loader.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::gateway {

/// Finds `canopen/NAME.eds` and `canopen/NAME.dcf` where `loader` looks: in the mechanism's folder, then among what is
/// shared. `loader` must live as long.
[[nodiscard]] fieldbus::canopen::FindDescription find_descriptions(const ModuleLoader& loader);

}  // namespace rmac::gateway
