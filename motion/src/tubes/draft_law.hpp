#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "splines/line_spline.hpp"
#include "time_law/law_problem.hpp"
#include "tubes/tube_program.hpp"

namespace rmac {

/// What a line of a polyline may be travelled with.
struct LineLimits {
  std::vector<Vector> rates;  ///< d(joint)/d(tip), a joint
  double feed_mm_s = 0;
  double rise_mm_s2 = 0, fall_mm_s2 = 0;  ///< infinity where the joints alone bound it
};

/// The limits of each line; nothing where the joints' rates cannot be had.
[[nodiscard]] std::optional<std::vector<LineLimits>> line_limits(const PathSegments& lines);

/// The time law of a spline that is still being shaped, from open to open end, and what the bounds of jerk cost there
/// (docs/derivations/joins.md, section 7). Only as good as is needed to compare splines: the joints' rates are taken as
/// constant on a line.
class DraftLaw {
 public:
  DraftLaw(const std::vector<double>& knots, const Polyline& polyline, std::vector<LineLimits> lines,
           const std::vector<JointLimits>& joints);

  /// The time that the spline takes; infinite where no law was found.
  [[nodiscard]] double solve(const std::vector<Vector>& points);
  /// What the laws so far ask of a spline that is to replace `points`, on which the last of them was.
  [[nodiscard]] std::vector<SplineDemand> demands(const std::vector<Vector>& points);

 private:
  /// A node of the law's grid: the spline's derivatives there as weights of its control points.
  struct Node {
    std::array<quintic::Basis, 3> derivatives;
    std::size_t line = 0;
  };

  std::vector<JointLimits> joints_;
  std::vector<LineLimits> lines_;
  std::vector<Node> nodes_;
  LawProblem problem_;
  LawSolution law_;
  std::vector<double> prices_;  ///< of jerk, a mean over the laws
};

}  // namespace rmac
