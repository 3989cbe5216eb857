#include "tubes/faster_in_tube.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gives_way.hpp"
#include "tubes/tube_spline.hpp"

namespace rmac {
namespace {

/// Laws and splines in turn; more bring next to nothing.
constexpr int kRounds = 6;
/// Work after which no other round is begun, of `TubeProgram::solve`: what more would bring is not worth its time.
constexpr double kMostWork = 65'000;
/// And for a second of the window's motion: where many tiny lines are soon travelled, planning is to be faster still.
constexpr double kMostWorkASecond = 100'000;
/// Tubes, each narrower by what the spline was outside between the samples.
constexpr int kTrials = 3;

}  // namespace

FasterInTube::FasterInTube(SplineInTube spline, DraftLaw law) : spline_(std::move(spline)), law_(std::move(law)) {}

bool FasterInTube::step() {
  if (gives_way()) return true;  // later
  if (!program_) {
    begin_trial();
    return true;
  }
  if (rounds_ < kRounds && round()) return true;
  return faster_ && goes_on_narrower();
}

void FasterInTube::begin_trial() {
  ++trials_;
  rounds_ = 0;
  faster_ = false;
  fastest_ = spline_.points;
  trial_ = fastest_;
  least_s_ = law_.solve(trial_);
  program_.emplace(spline_.kept, trial_);
  lay_tube_samples(spline_.knots, spline_.polyline, spline_.widths_mm, spline_.kept, *program_);
}

bool FasterInTube::round() {
  ++rounds_;
  const double most_work = std::min(kMostWork, kMostWorkASecond * least_s_);
  if (!std::isfinite(least_s_) || static_cast<double>(work_) > most_work) return false;
  if (!program_->solve(law_.demands(trial_), true, work_)) return false;
  const double time_s = law_.solve(trial_);
  if (!std::isfinite(time_s)) return false;
  if (time_s < least_s_) {
    least_s_ = time_s;
    fastest_ = trial_;
    faster_ = true;
  }
  return true;
}

bool FasterInTube::goes_on_narrower() {
  auto distances = tube_distances(spline_.knots, fastest_, spline_.polyline, spline_.tolerance_mm);
  const double part = largest_part(distances, spline_.polyline, spline_.tolerance_mm);
  if (part <= 1) {
    found_ = Found{std::move(fastest_), std::move(distances)};
    return false;
  }
  for (double& width : spline_.widths_mm) width *= 0.995 / part;
  program_.reset();
  return trials_ < kTrials;
}

}  // namespace rmac
