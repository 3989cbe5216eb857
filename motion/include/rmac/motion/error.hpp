#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace rmac {

/// Why something was refused or failed: the dissertation's `StatusMinorCode` (Appendix IV), numbered as on the wire.
enum class MinorCode : int {
  None = 0,
  Unknown = 1,
  EmergencyStop = 2,
  NoAir = 3,
  TravelLimit = 4,
  SpeedLimit = 5,
  AccelerationLimit = 6,
  ProbeNotArmed = 7,
  Scale = 8,
  PartNotFound = 9,
  UnexpectedHit = 10,
  CommTimeout = 11,
  ResponseTimeout = 12,
  InvalidParameter = 13,
  InvalidParameterValue = 14,
  CommandQueueFull = 15,
  UnsupportedOperation = 16,
  Other = 17,
};

/// What happened, where, and what to do, in one message for a person; the code is for programs. Never made on the servo
/// thread.
struct Error {
  MinorCode code = MinorCode::Other;
  std::string message;
};

template <typename T = void>
using Expected = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> failure(MinorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace rmac
