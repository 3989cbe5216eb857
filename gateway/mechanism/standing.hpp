#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gateway/mechanism/mechanism.hpp"

namespace rmac::gateway {

/// Where the joints of `next` (held ones included) stand while those of `now` stand at `position`: back through `now`'s
/// actuator map to the encoders, and forth through `next`'s. Nothing when `next` has a drive that `now` has not, or
/// when either mechanism is virtual.
[[nodiscard]] std::optional<std::vector<double>> standing_after(const Mechanism& now, std::span<const double> position,
                                                                const Mechanism& next);

/// Refuses limits that exclude where a joint stands. A joint may stand beyond them by rounding, or, with
/// `as_measured`, by as much as it may be off its setpoint.
[[nodiscard]] Expected<> check_standing(const sdk::DeviceObject& device, std::span<const double> position,
                                        bool as_measured);

}  // namespace rmac::gateway
