#pragma once

#include <optional>

#include "clients/legacy/program/writer.hpp"

namespace rmac::apt {

/// Which way arcs go about the axis of a CIRCLE record, seen against it.
enum class CircleAxis { Clockwise, CounterClockwise };

/// What whoever imports a program says of it, because it does not say it itself.
struct Options {
  double rapid_mm_min = 3000;                 ///< of RAPID: the appliance positions at the feed in force
  std::optional<double> unit_mm;              ///< of a program without UNITS
  std::optional<legacy::Point> approach_mm;   ///< where the tip goes first, and after each tool change
  std::optional<legacy::Point> reference_mm;  ///< of GOHOME, in the coordinates of the part
  bool multax = false;                        ///< as if the program began with MULTAX/ON
  std::optional<CircleAxis> circle_axis;      ///< of CIRCLE records that do not tell their direction
  legacy::Ids ids = legacy::Ids::Numbers;
};

}  // namespace rmac::apt
