#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "gateway/material/sweep/cutter_profile.hpp"
#include "gateway/material/sweep/sweep.hpp"

namespace rmac::gateway {

/// Where a tool stands in the part frame: its tip, and the unit axis from the tip to the spindle. mm.
struct ToolAt {
  Eigen::Vector3d tip, axis;
};

/// Makes straight strokes of the true motion of one piece of a tool: as long as no point of the piece is farther than a
/// tolerance from where the true motion has it, in all positions that were told. What the piece sweeps is so known to
/// that tolerance, however the tool turns.
class StrokeMaker {
 public:
  StrokeMaker(const ProfilePiece& piece, double tolerance_mm) : piece_(piece), tolerance_mm_(tolerance_mm) {}

  [[nodiscard]] const ProfilePiece& piece() const noexcept { return piece_; }
  /// How far a point of the piece can be from the stroke between two positions, at either.
  [[nodiscard]] double turned_mm(const ToolAt& from, const ToolAt& to) const;

  /// The piece goes on to there. When that is no longer on the stroke under way, that stroke, which is over.
  [[nodiscard]] std::optional<Stroke> go_to(const ToolAt& there);
  /// The stroke under way; none where nothing moved. What comes next begins where it ended, or with `forget` anywhere.
  [[nodiscard]] std::optional<Stroke> end();
  void forget() { passed_.clear(); }

 private:
  static constexpr std::size_t kMost = 64;  ///< positions of a stroke
  struct Position {
    Eigen::Vector3d middle, axis;
  };
  [[nodiscard]] bool on_stroke_to(const Position& there) const;
  [[nodiscard]] Stroke stroke() const;

  ProfilePiece piece_;
  double tolerance_mm_;
  std::vector<Position> passed_;  ///< of the stroke under way, its beginning first
};

}  // namespace rmac::gateway
