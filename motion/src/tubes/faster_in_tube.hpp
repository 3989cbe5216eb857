#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "splines/line_spline.hpp"
#include "tubes/draft_law.hpp"
#include "tubes/tube_program.hpp"

namespace rmac {

/// What is made faster: a spline over `knots` that stays within widths_mm[k] of line k of the polyline (as in
/// `smoothest_in_tube`). The first `kept` of its control points stay as they are, and the last.
struct SplineInTube {
  std::vector<double> knots;
  Polyline polyline;
  std::vector<double> widths_mm;
  double tolerance_mm = 0;  ///< of the lines, by `tube_distances`
  std::size_t kept = 0;
  std::vector<Vector> points;
};

/// Makes a spline in the tube faster to travel (docs/derivations/joins.md, section 7): laws and splines in turn, a
/// round a step, for a window takes longer than the planner may be held up. Planner thread.
class FasterInTube {
 public:
  /// Control points within the tolerance, and the deviation from each line.
  struct Found {
    std::vector<Vector> points;
    std::vector<double> deviations_mm;
  };

  FasterInTube(SplineInTube spline, DraftLaw law);
  FasterInTube(const FasterInTube&) = delete;  // the program keeps a reference to the trial
  FasterInTube& operator=(const FasterInTube&) = delete;
  ~FasterInTube() = default;

  /// Does some of the work; false once there is none left.
  [[nodiscard]] bool step();
  /// Nothing where no faster spline was found.
  [[nodiscard]] const std::optional<Found>& found() const noexcept { return found_; }

 private:
  void begin_trial();
  /// A spline by the law of the one before, and its law; false where there is no other.
  bool round();
  /// Whether what the rounds found is still outside of the tolerance between the samples, and a narrower tube is tried.
  bool goes_on_narrower();

  SplineInTube spline_;
  DraftLaw law_;
  std::optional<TubeProgram> program_;  ///< of this trial
  std::vector<Vector> trial_, fastest_;
  double least_s_ = std::numeric_limits<double>::infinity();
  bool faster_ = false;
  int trials_ = 0, rounds_ = 0;
  std::size_t work_ = 0;
  std::optional<Found> found_;
};

}  // namespace rmac
