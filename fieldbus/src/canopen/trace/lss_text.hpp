#pragma once

#include <string>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

inline constexpr std::uint16_t kLssRequestId = 0x7E5, kLssAnswerId = 0x7E4;

/// What a frame of layer setting services says: "LSS configure node id 5" (CiA 305).
[[nodiscard]] std::string lss_text(const CanFrame& frame);

}  // namespace rmac::fieldbus::canopen
