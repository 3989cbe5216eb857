#pragma once

#include <cstddef>
#include <span>

#include "rmac/fieldbus/can/can_controller.hpp"

namespace rmac::fieldbus {

/// What the kernel's answer to RTM_GETLINK (rtnetlink(7)) says of a CAN controller. Unknown where it is no such answer,
/// is cut short, or speaks of an interface without one.
[[nodiscard]] CanController controller_of(std::span<const std::byte> answer) noexcept;

}  // namespace rmac::fieldbus
