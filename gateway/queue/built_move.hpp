#pragma once

#include <vector>

#include "gateway/queue/program_log.hpp"
#include "gateway/queue/queue_step.hpp"

namespace rmac::gateway {

/// A move, or a part of one, as a client sent it and as it is to be planned.
struct BuiltMove {
  ProgramStep as_sent;  ///< holds a `Move`
  MovePart part;
  PathSegments segments;  ///< none where there is nothing to move
};

struct PartOfMove {
  const Move* move = nullptr;
  MovePart part;
};

/// Builds all of them, each behind the one before, or none: then `builder` stands where it stood. May take long.
[[nodiscard]] Expected<std::vector<BuiltMove>> build_moves(PathBuilder& builder, const std::vector<PartOfMove>& parts);

}  // namespace rmac::gateway
