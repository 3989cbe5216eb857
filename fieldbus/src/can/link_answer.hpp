#pragma once

#include <cstddef>
#include <span>

#include "rmac/fieldbus/can/can_controller.hpp"

namespace rmac::fieldbus {

/// Asks the kernel for an interface (RTM_GETLINK, rtnetlink(7)): its answer, of what stands in `answer`; empty where it
/// gives none.
[[nodiscard]] std::span<const std::byte> ask_for_link(int interface_index, std::span<std::byte> answer) noexcept;

/// What the kernel's answer says of a CAN controller. Unknown where it is no such answer,
/// is cut short, or speaks of an interface without one.
[[nodiscard]] CanController controller_of(std::span<const std::byte> answer) noexcept;

}  // namespace rmac::fieldbus
