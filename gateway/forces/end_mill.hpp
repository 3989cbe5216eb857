#pragma once

#include "gateway/tools/tool_shape.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// The cutting edges of a flat, bull-nose or ball end mill, by the profile that they turn on: a quarter of a circle of
/// the corner radius, then a cylinder up to the end of the flutes. All teeth are alike, as far from each other, and of
/// constant lead. What a flat end cuts below its corner is no part of it.
class EndMill {
 public:
  /// Refused, with the key that is missing, where the shape does not say how many teeth there are.
  [[nodiscard]] static Expected<EndMill> of(const ToolShape& shape);

  /// A place on the edge, by how far it is along the profile from its lowest point.
  struct Place {
    double z_mm = 0;              ///< above the tip
    double radius_mm = 0;         ///< from the axis
    double sin_k = 1, cos_k = 0;  ///< of the angle between the axis and the normal of the profile; at the cylinder 90°
    double edge_per_profile = 1;  ///< how much longer the edge is than the profile, for its helix
  };
  [[nodiscard]] Place at(double profile_mm) const noexcept;
  /// The place along the profile that is so high above the tip.
  [[nodiscard]] double profile_at(double z_mm) const noexcept;
  /// Where along the profile the corner ends.
  [[nodiscard]] double corner_ends_mm() const noexcept;

  [[nodiscard]] double radius_mm() const noexcept { return radius_mm_; }
  [[nodiscard]] double corner_radius_mm() const noexcept { return corner_mm_; }
  [[nodiscard]] double cutting_length_mm() const noexcept { return length_mm_; }
  [[nodiscard]] int teeth() const noexcept { return teeth_; }
  /// By how much an edge lags behind its lowest point for each millimetre above the tip, rad/mm.
  [[nodiscard]] double lag_per_mm() const noexcept { return lag_per_mm_; }

 private:
  EndMill() = default;
  double radius_mm_ = 0, corner_mm_ = 0, length_mm_ = 0, lag_per_mm_ = 0;
  int teeth_ = 0;
};

}  // namespace rmac::gateway
