#pragma once

#include <vector>

#include "gateway/tools/tool_shape.hpp"

namespace rmac::gateway {

/// A convex solid of revolution about a tool's axis, one of those that the tool is made of. mm, from the tip up.
struct ProfilePiece {
  enum class Kind {
    Ball,         ///< of radius `rounded`
    RoundedDisc,  ///< a disc of `bottom_radius` that is `rounded` in every direction: the corner of a bull nose
    Cone          ///< or cylinder, with flat ends
  };
  Kind kind = Kind::Cone;
  double middle = 0;  ///< of its height, above the tip
  double bottom_radius = 0, top_radius = 0, height = 0;
  double rounded = 0;

  /// How far a point of it moves at most when the tool turns by a radian about the piece's middle and across its axis.
  [[nodiscard]] double lever() const noexcept;
};

/// The part of a tool that cuts: up to LCF, its end as DC and RE have it.
[[nodiscard]] std::vector<ProfilePiece> cutting_profile(const ToolShape& shape);

/// Cones one on the other from `from_mm` above the tip, `below_mm` within their surfaces: what stays when so much of
/// them does not count. One that is no thicker is left out.
[[nodiscard]] std::vector<ProfilePiece> profile_of(const std::vector<ConeShape>& sections, double from_mm,
                                                   double below_mm);

}  // namespace rmac::gateway
