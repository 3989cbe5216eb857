#pragma once

#include <cstddef>

namespace rmac {

/// Most joints a mechanism may have, held ones included (the dissertation's DMAC_MAX_JNT), and most motors.
inline constexpr std::size_t kMaxJoints = 32;
inline constexpr std::size_t kMaxSpindles = 4;

}  // namespace rmac
