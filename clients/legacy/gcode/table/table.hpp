#pragma once

#include <array>
#include <vector>

#include "clients/legacy/program/arc_geometry.hpp"
#include "clients/legacy/program/vectors.hpp"

namespace rmac::gcode {

/// Of A, B and C, degrees.
using TableAngles = std::array<double, 3>;

/// An axis that turns the part, counter-clockwise about the normal of its plane as the tool goes round the part.
struct TableAxis {
  std::size_t angle = 0;  ///< which of TableAngles
  legacy::Plane plane;
  double sign = 1;
  legacy::Point centre{};  ///< a point on it while all stand at 0, mm
};

/// From the part to the tool: each carries those before it.
using Table = std::vector<TableAxis>;

/// Leads from coordinates that do not turn with the table to those of the part.
[[nodiscard]] legacy::Placement placement_of(const Table& table, const TableAngles& angles);

/// A straight move of the tool, upright, while the table turns evenly.
struct TableMove {
  legacy::Point from{}, to{};  ///< of the tip, in coordinates that do not turn with the table
  TableAngles begin{}, end{};
};

/// Of a whole curve a share, from 0 to 1: its value and its derivatives by the share.
struct Jet {
  legacy::Point at{}, first{}, second{};
};

/// Tip and axis of the tool as the part sees them.
[[nodiscard]] Jet tip_at(const Table& table, const TableMove& move, double share);
[[nodiscard]] Jet axis_at(const Table& table, const TableMove& move, double share);

}  // namespace rmac::gcode
