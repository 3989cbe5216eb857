#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gateway/collision/scene_body.hpp"

namespace rmac::gateway {

/// Two bodies of a scene that may not meet, by their places in it, the first before the second.
struct BodyPair {
  std::size_t first = 0, second = 0;
  bool with_stock = false;
  bool cutter_in_stock = false;  ///< which is what a cut is
  bool tool_in_stock = false;    ///< cutter, shank or holder
  bool core_in_part = false;     ///< they may touch: only what is too deep counts
};

/// Neighbours on the chain slide or turn in each other; what stands on the table and what is in the spindle was put
/// there, and is held against all that moves against it. Cutting touches the part: of a cutter only its core is held
/// against it, and against nothing else. `bodies`: those of the tool last.
[[nodiscard]] std::vector<BodyPair> body_pairs(std::span<const SceneBody> bodies);

}  // namespace rmac::gateway
