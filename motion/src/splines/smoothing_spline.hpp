#pragma once

#include <limits>
#include <vector>

#include "rmac/motion/pose.hpp"
#include "splines/quintic.hpp"

namespace rmac {

/// A place that a spline is to pass, at a parameter of it. What shapes the spline within `width_mm` of it is smoothed
/// away: the less that is, the nearer it passes.
struct SplineSample {
  double place = 0;
  Vector point{};
  std::size_t line = 0;  ///< of the polyline it is on; the first of two
  double share = 0;      ///< length that it stands for
  double width_mm = 0;
  double most_mm = std::numeric_limits<double>::infinity();  ///< that the width may be
  double limit = 0;                                          ///< that it may be missed by: mm, or rad of the tool axis
  double used = 0;  ///< of that, by the line itself, which misses what was sent
  double off = 0;   ///< by how much the spline may miss what lies between it and the next sample
};

/// The quintic spline that is as smooth as the samples' widths w allow (docs/derivations/joins.md, section 6):
/// min ∫ |S'''|² + Σ share w⁻⁶ |S(place) - point|².
class SmoothingSpline {
 public:
  /// Samples in the order of their places, the last where the spline ends.
  SmoothingSpline(const std::vector<double>& knots, std::vector<SplineSample>& samples);

  /// The first `kept` of `points`, one or more, are given and stay; the last becomes the last sample's; the others are
  /// found. Tells the samples by how much the spline may miss them and the straight ways between them (eq. 10). False
  /// where numbers fail.
  [[nodiscard]] bool solve(std::size_t kept, std::vector<Vector>& points);
  /// ∫ |S'''|².
  [[nodiscard]] double roughness(const std::vector<Vector>& points) const;

 private:
  void measure(const std::vector<Vector>& points);

  const std::vector<double>& knots_;
  std::vector<SplineSample>& samples_;
  std::vector<quintic::Basis> at_samples_;
  std::vector<quintic::Basis> third_;  ///< derivative, at the places of the quadrature of each span
};

}  // namespace rmac
