#pragma once

#include <cstdint>

namespace rmac {

/// How joints came off their path.
struct PathDeparture {
  enum class Cause : std::uint8_t {
    Stop,        ///< told to stop, and no plan to do so on the path was there in time
    NoSolution,  ///< the kinematics had no joints for a pose of the path, which they had when it was planned
    NotANumber,  ///< or gave something that is no number
    Jump,        ///< or joints that the joint could not have come to within a cycle
  };
  std::uint64_t count = 0;  ///< departures so far: 0, never
  std::uint64_t plan = 0;   ///< the plan that was followed
  std::int64_t cycle = 0;   ///< its last setpoint was this cycle's
  Cause cause = Cause::Stop;
  std::uint32_t joint = 0;  ///< that was found wrong, where it was one
};

}  // namespace rmac
