#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/measuring.hpp"

namespace rmac::gateway {

/// What happened, in order. Made off the servo thread from what its fault ring reports.
struct Event {
  enum class Kind : std::uint8_t {
    MoveStarted,
    MoveDone,
    Hit,
    Stopped,
    Fault,
    Authority,
    Operator,
    Mechanism,
    CycleStateChanged,
    FlightRecord,
    FlightRecordFailed,
    ToolWanted,
    ToolChanged,
    ToolChangeDropped,
    ProgramStopped,
    Bus,
    CollisionAhead,
    NotChecked
  };
  Kind kind = Kind::Stopped;
  double t_s = 0;
  std::int64_t move_id = 0;
  std::string message;               ///< for a person: what happened, where, what to do
  std::int64_t cycle = 0;            ///< in which it happened, or was noticed off the servo thread
  std::string record;                ///< name of the flight record that shows it; empty: none
  MinorCode code = MinorCode::None;  ///< the status that it leaves
  std::optional<sdk::Hit> hit{};     ///< what a `Kind::Hit` found
  bool goes_on = false;              ///< the cycle runs from now on: what stopped it before is over
  std::uint64_t order = 0;           ///< among what was told and queued off the servo thread; 0: it is not of that
};

}  // namespace rmac::gateway
