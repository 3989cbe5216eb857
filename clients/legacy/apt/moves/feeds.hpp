#pragma once

#include <optional>

#include "clients/legacy/apt/moves/coordinates.hpp"

namespace rmac::apt {

/// Takes the unit of a feed where it is the next word: MMPM, IPM, or PERMIN of the program's unit; in mm/min. Feeds a
/// turn of the spindle, and a share of the way, are refused.
[[nodiscard]] std::optional<double> take_feed_unit(Arguments& arguments, const Coordinates& coordinates);

/// FEDRAT/f, with the unit before or behind it, which is kept for those that follow; without, that of an earlier one,
/// or of the program. In mm/min.
[[nodiscard]] double feed_of(Arguments& arguments, const Coordinates& coordinates, std::optional<double>& unit);

}  // namespace rmac::apt
