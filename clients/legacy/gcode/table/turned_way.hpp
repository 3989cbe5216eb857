#pragma once

#include <variant>
#include <vector>

#include "clients/legacy/gcode/table/table.hpp"
#include "clients/legacy/program/writer.hpp"

namespace rmac::gcode {

/// A stretch of the tool's way about the part. A line and an arc turn the tool's axis evenly; to `axis` at their end.
struct TurnedLine {
  legacy::Point end{}, axis{};
};
struct TurnedArc {
  legacy::Arc arc;
  legacy::Point axis{};
};
using TurnedPiece = std::variant<TurnedLine, TurnedArc, legacy::PoseSpline>;

struct TurnedWay {
  std::vector<TurnedPiece> pieces;
  double length_mm = 0;      ///< of the tip on the part; 0: it rests there
  double turn_degrees = 0;   ///< of all axes, as if they were coordinates
  bool rests_askew = false;  ///< the tip rests, and the tool does not turn in one plane: no piece says that
};

/// How far a spline may be from the way of the tip, mm: less than the digits of any program.
inline constexpr double kSplineTolerance_mm = 1e-5;
/// Whole turns that one move may have.
inline constexpr double kMostTableTurns = 1000;

/// The way of the tool about the part. Where one axis turns and the tip keeps its distance from it, an arc or a helix;
/// a tip on the axis goes straight. Both are exact, but that a way or a radius of up to 2 um is as good as none.
/// Elsewhere a spline of degree 5, within kSplineTolerance_mm. `move` turns something, by no more than kMostTableTurns.
[[nodiscard]] TurnedWay turned_way(const Table& table, const TableMove& move);

}  // namespace rmac::gcode
