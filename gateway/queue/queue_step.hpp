#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

// What a tool change is made of, and what waits behind it. Each step but a path is taken at rest, when all before it is
// done, and while the cycle runs.

/// One client move may be several of the planner's: which of them this is.
struct MovePart {
  bool first = true, last = true;
};

using PathSegments = std::vector<std::shared_ptr<const PathSegment>>;

/// Segments of one move: none where there is nothing to move.
struct QueuedPath {
  std::int64_t move_id = 0;
  MovePart part;
  PathSegments segments;
};
/// Spindles stop, and `outputs_off` (the coolant) go off. From here on nobody can say which tool is in the spindle.
struct BeginToolChange {
  std::uint64_t outputs_off = 0;
};
struct SwitchOutputs {
  std::uint64_t mask = 0;
  std::uint64_t values = 0;
};
/// Waits for an input; a fault when it does not come in time.
struct AwaitInput {
  std::uint64_t bit = 0;
  bool on = true;
  double timeout_s = 0;
  std::string name{};
  std::optional<double> since_s{};
};
/// Waits for a person.
struct AskPerson {
  std::string text{};
};
/// The tool is in the spindle, and its tip where `tip` says on the tool interface.
struct MountTool {
  int number = 0;
  Frame tip{};
  std::string text{};        ///< the tool, for people
  double max_torque_nm = 0;  ///< that it bears; 0: not given
};

using QueueStep = std::variant<QueuedPath, BeginToolChange, SwitchOutputs, AwaitInput, AskPerson, MountTool>;

}  // namespace rmac::gateway
