#pragma once

#include <Eigen/Geometry>
#include <variant>

#include "gateway/material/sweep/cutter_profile.hpp"
#include "gateway/material/sweep/swept_ball.hpp"
#include "gateway/material/sweep/swept_cone.hpp"
#include "gateway/material/sweep/swept_disc.hpp"

namespace rmac::gateway {

/// A piece of a tool that moves along a line without turning. Part frame, mm.
struct Stroke {
  Eigen::Vector3d from, to;  ///< of the piece's middle
  Eigen::Vector3d axis;      ///< unit, from the tip to the spindle
};

using Sweep = std::variant<SweptBall, SweptDisc, SweptCone>;

/// Everything that the piece passes, exactly: what a line along an axis of the part frame has in it is computed, not
/// sampled.
[[nodiscard]] inline Sweep sweep_of(const ProfilePiece& piece, const Stroke& stroke) {
  const Eigen::Vector3d way = stroke.to - stroke.from;
  switch (piece.kind) {
    case ProfilePiece::Kind::Ball:
      return SweptBall(stroke.from, way, piece.rounded);
    case ProfilePiece::Kind::RoundedDisc:
      return SweptDisc(stroke.from, way, stroke.axis, piece.bottom_radius, piece.rounded);
    case ProfilePiece::Kind::Cone:
      break;
  }
  return SweptCone(stroke.from, way, stroke.axis, {piece.bottom_radius, piece.top_radius, piece.height});
}

}  // namespace rmac::gateway
