#include "gateway/simulators/vdrive/axis/axis_parameters.hpp"

#include <algorithm>

namespace rmac::vdrive {

AxisParameters read_parameters(const Dictionary& dictionary, const AxisUnits& units,
                               const fieldbus::AxisPlantParameters& mechanics) {
  const auto of = [&](std::uint16_t index, std::uint8_t sub = 0) {
    return static_cast<double>(dictionary.number(index, sub));
  };
  const auto counts = [&, per_count = units.per_count()](std::uint16_t index, std::uint8_t sub = 0) {
    return of(index, sub) / per_count;
  };
  const double to_position = units.of_position();
  const bool has_limits = of(0x607D, 1) < of(0x607D, 2);
  const double one_end = of(0x607D, 1) / to_position, other_end = of(0x607D, 2) / to_position;
  const double target_velocity = of(0x60FF) / units.of_velocity() + counts(0x60B1);
  const double most_permille = std::min(of(0x6072), 1000 * mechanics.peak_torque_nm / mechanics.rated_torque_nm);
  return {.velocity = std::min(counts(0x6081), counts(0x607F)),
          .acceleration = counts(0x6083),
          .deceleration = counts(0x6084),
          .quick_stop = counts(0x6085),
          .homing_acceleration = counts(0x609A),
          .fast = counts(0x6099, 1),
          .slow = counts(0x6099, 2),
          .top_velocity = counts(0x607F),
          .target_velocity = std::clamp(target_velocity, -counts(0x607F), counts(0x607F)),
          .torque_slope = of(0x6087) / 1000 * mechanics.rated_torque_nm,
          .target_torque = (of(0x6071) + of(0x60B2)) / 1000 * mechanics.rated_torque_nm,
          .torque_offset = of(0x60B2) / 1000 * mechanics.rated_torque_nm,
          .velocity_offset = counts(0x60B1),
          .own_velocity = of(0x2002) / 1000,
          .most_torque = most_permille / 1000 * mechanics.rated_torque_nm,
          .least_position = has_limits ? std::min(one_end, other_end) : -2147483648.0,
          .most_position = has_limits ? std::max(one_end, other_end) : 2147483647.0,
          .window = counts(0x6067),
          .window_s = of(0x6068) / 1000,
          .velocity_window = counts(0x606D),
          .velocity_window_s = of(0x606E) / 1000,
          .error_window = of(0x6065) < 4294967295.0 ? counts(0x6065) : 4294967295.0,
          .error_s = of(0x6066) / 1000,
          .home_offset = of(0x607C) / to_position,
          .slow_velocity = counts(0x606F),
          .switches = {.negative_limit = of(0x2000, 1),
                       .positive_limit = of(0x2000, 2),
                       .cam_from = of(0x2000, 3),
                       .cam_to = of(0x2000, 4),
                       .index = of(0x2000, 5),
                       .touches_from = of(0x2000, 6),
                       .touches_to = of(0x2000, 7)},
          .options = {.quick_stop = static_cast<int>(of(0x605A)),
                      .shutdown = static_cast<int>(of(0x605B)),
                      .disable_operation = static_cast<int>(of(0x605C)),
                      .fault_reaction = static_cast<int>(of(0x605E))},
          .halting = braking_of(static_cast<int>(of(0x605D))),
          .homing_method = static_cast<int>(of(0x6098)),
          .controlword = static_cast<std::uint16_t>(dictionary.number(0x6040))};
}

}  // namespace rmac::vdrive
