#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Says how far a path may be travelled before anything of it is planned: the planner's path grows only by what has
/// passed, so that every plan ends at rest before what has not. Segments are those that are travelled, corners rounded
/// and short lines joined, in their order. Called by whoever has the planner; none of it may take long.
class PathGate {
 public:
  struct Answer {
    enum class Kind : std::uint8_t {
      Wait,    ///< not known yet
      Passes,  ///< to its end
      Part,    ///< up to a place; what lies behind is being looked at
      Blocks   ///< up to a place, and never farther
    };
    Kind kind = Kind::Wait;
    double up_to = 0;  ///< path length on the segment
  };

  PathGate() = default;
  PathGate(const PathGate&) = delete;
  PathGate& operator=(const PathGate&) = delete;
  virtual ~PathGate() = default;

  /// Hands over what follows what was handed over before.
  virtual void ask(std::shared_ptr<const PathSegment> segment) = 0;
  /// Of the first segment that has not passed, or was blocked.
  [[nodiscard]] virtual Answer answer() = 0;
  /// What was handed over is dropped; what comes next begins elsewhere.
  virtual void forget() = 0;
  /// So many segments are handed over before there is an answer of the first.
  [[nodiscard]] virtual std::size_t ahead() const noexcept = 0;
};

}  // namespace rmac
