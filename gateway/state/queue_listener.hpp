#pragma once

#include <functional>
#include <memory>
#include <span>

#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac::gateway {

/// Hears of a move as it is queued, and of the curves it has become: none when there is nothing to move. What is done
/// between moves is told as a target without joints.
using QueueListener = std::function<void(const Move&, std::span<const std::shared_ptr<const PathSegment>>)>;

}  // namespace rmac::gateway
