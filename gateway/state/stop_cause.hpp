#pragma once

#include <cstdint>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Why the machine came to rest.
enum class StopCause : std::uint8_t {
  CycleStop,
  CycleEnded,
  StopNow,
  JogLapsed,
  JogEnded,
  MoveDone,
  RetraceEnded,
  Homed,
  HitByHand,
  UnexpectedHit,
  PartNotFound,
  AirLost,
  Parked,
  ProbeLost,
  ProbeDeflected,
  ProbeStuck
};

/// What happened, and what to do to go on.
[[nodiscard]] const char* describe(StopCause cause) noexcept;
/// The status that such a stop leaves; None where nothing went wrong.
[[nodiscard]] MinorCode code_of(StopCause cause) noexcept;

}  // namespace rmac::gateway
