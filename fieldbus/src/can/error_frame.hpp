#pragma once

#include <linux/can.h>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus {

/// Counts what an error frame reports (linux/can/error.h). Real-time safe.
void take_error_frame(const can_frame& report, CanHealth& health) noexcept;

}  // namespace rmac::fieldbus
