#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/table/turned_way.hpp"

namespace rmac::gcode {

/// What F counts by.
struct FeedModes {
  const Options& options;
  const Rules& rules;
  const Modes& modes;
};

/// How long F has a feed move take that goes `way` about the part. `place`: for refusals.
[[nodiscard]] double minutes_of(const TableMove& move, const TurnedWay& way, const FeedModes& feed, std::size_t place);

void write(const TurnedWay& way, Writer& writer);

}  // namespace rmac::gcode
