#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

struct ServoBus;

/// What a loop leaves to the one that comes after it, drive by drive, so that nothing jumps.
struct ServoHandover {
  /// Shaft angles in the drive's sense.
  struct Beside {
    double belongs_rad = 0;  ///< by which it is ahead of the others where they stand as they belong, counters at 0
    double left_rad = 0;     ///< of what was amiss as power came
  };
  struct Drive {
    const ServoBus* bus = nullptr;
    std::uint32_t axis = 0;      ///< of the bus
    std::int64_t counts = 0;     ///< unwrapped
    double setpoint_counts = 0;  ///< wanted position in encoder counts, before rounding
    double torque_nm = 0;        ///< commanded, in the drive's sense
    double backlash_side = 0;    ///< flank that carries, -1 to 1 in the drive's sense; 0 where several joints share it
    std::optional<Beside> beside{};  ///< of a motor that moves its joint beside others
    bool live = false;               ///< was under control
    bool seen = false;               ///< `counts` holds a reading
    bool believed = false;           ///< it was confirmed
    bool referenced = false;         ///< the drive found home, or needs none
    bool reference_lost = false;
  };
  std::array<Drive, kMaxJoints> drives{};
  std::size_t count = 0;
};

}  // namespace rmac
