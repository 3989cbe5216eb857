#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/tools/tool.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

// What stands between moves: what a tool change is made of, what a program does in its turn, and what waits behind it.
// Each but a path, and a switch of outputs alone, is taken at rest, when all before is done, and while the cycle runs.

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
  std::string text{};                  ///< the tool, for people
  double max_torque_nm = 0;            ///< that it bears; 0: not given
  std::shared_ptr<const Tool> tool{};  ///< as the table has it when the change is queued
};

/// The program rests for so long.
struct Dwell {
  double time_s = 0;
};
/// The program is held, until a person goes on. An optional stop only where those are switched on.
struct ProgramStop {
  bool optional = false;
  std::string message{};
};
/// Spindles and outputs that are switched together, in this order.
struct Switch {
  struct Speed {
    std::size_t spindle = 0;
    double rpm = 0;
  };
  struct Output {
    std::string name{};
    bool on = false;
    std::uint64_t bit = 0;
  };
  std::vector<Speed> speeds{};
  std::vector<Output> outputs{};
};
[[nodiscard]] SwitchOutputs outputs_of(const Switch& switching);

/// What a program does between two of its moves, with an id as a move has.
struct InTurn {
  std::int64_t move_id = 0;
  std::variant<Dwell, ProgramStop, AwaitInput, Switch> what;
};
/// As events name it: "dwell 7".
[[nodiscard]] std::string name_of(const InTurn& turn);

using QueueStep = std::variant<QueuedPath, BeginToolChange, SwitchOutputs, AwaitInput, AskPerson, MountTool, InTurn>;

}  // namespace rmac::gateway
