#pragma once

#include <cstdint>
#include <string>

namespace rmac {

/// Id of the moves that the controller makes for itself (jogs, `home`, the way of a tool change); clients' own ids are
/// what they chose.
inline constexpr std::int64_t kPositioningMoveId = -1;

/// How messages about it name a move: "move 7", or "this move" where no client numbered it.
inline std::string move_name(std::int64_t id) {
  return id == kPositioningMoveId ? "this move" : "move " + std::to_string(id);
}

}  // namespace rmac
