#pragma once

#include <optional>

#include "clients/legacy/apt/moves/coordinates.hpp"

namespace rmac::apt {

/// What CYCLE says of the holes that follow. Lengths are in mm along the tool axis from the GOTO of the hole, which is
/// where its top is.
struct Cycle {
  enum class Pecks { None, Breaking, Clearing };

  double depth_mm = 0, clear_mm = 0;  ///< below and above
  Pecks pecks = Pecks::None;
  double peck_mm = 0;
  bool comes_up_at_feed = false;      ///< boring and reaming
  std::optional<double> feed_mm_min;  ///< without: that of FEDRAT
  std::optional<double> dwell_s;      ///< at the bottom
  std::optional<double> return_mm;    ///< above; without: clear_mm
  bool returns_to_where_it_began = false;
};

/// Reads CYCLE/type,… but ON and OFF. Throws a Refusal of what needs the spindle's angle, and of what is not said.
[[nodiscard]] Cycle cycle_of(Arguments& arguments, const Coordinates& coordinates);

}  // namespace rmac::apt
