#pragma once

#include <cstdint>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::sdk {

/// The queue of moves. Gateway thread only.
class MoveQueue {
 public:
  virtual ~MoveQueue() = default;

  /// Checks and queues a move at what is in force; `geometry` is in the part frame. A full queue is CommandQueueFull:
  /// the caller waits and asks again.
  virtual Expected<> add(std::int64_t id, const Geometry& geometry) = 0;
  /// Moves queued and not yet done.
  [[nodiscard]] virtual int moves_left() const = 0;
  /// Joints that put the tool at `pose` (part frame); of several solutions the one nearest to the end of the queue.
  [[nodiscard]] virtual Expected<std::vector<double>> joints_at(const ToolPose& pose) const = 0;
};

}  // namespace rmac::sdk
