#pragma once

#include <optional>
#include <span>

#include "gateway/metrology/alignment.hpp"

// How far a tool is off what its table says, from what it cut. mm.

namespace rmac::gateway {

/// What is to be added to a tool's length and radius; none where nothing that was measured tells it.
struct ToolOffset {
  std::optional<double> length_mm, radius_mm;
};

/// From points on surfaces that the tool cut, in a part that lies at `frame`: a floor (its normal along the tool's
/// `axis` in the part, within 5 degrees) that lies too deep was cut by a longer tool, a wall (its normal square to the
/// axis) that lies too far in by a larger one. What leans between them tells both and is left out.
[[nodiscard]] ToolOffset tool_offset(std::span<const SurfacePoint> points, const Frame& frame, const Vector& axis);

}  // namespace rmac::gateway
