#include "tubes/tube_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tubes/tube_spline.hpp"

namespace rmac {
namespace {

constexpr double kSpansALine = 3;
/// Where a spline leaves the tolerance between its samples, the tube is made narrower.
constexpr int kTubeTrials = 3;
/// In tolerances: what is further out no narrower tube brings back.
constexpr double kFarOut = 2;

}  // namespace

TubeFit::TubeFit(TubeWindow window) : window_(std::move(window)) {
  laid_ = spline_.go_on(window_.before, inner_knots(), window_.polyline);
}

std::vector<double> TubeFit::inner_knots() const {
  // The spline swings from one side of each line to the other: three spans do that as well as more. A line much shorter
  // than its neighbours needs fewer.
  const std::vector<double>& places = window_.polyline.places;
  const std::size_t lines = window_.polyline.lines();
  const double from = window_.before.free_from();
  std::vector<double> inner;
  for (std::size_t k = 0; k < lines; ++k) {
    double longest = 0;
    for (std::size_t i = k > 1 ? k - 2 : 0; i <= k + 2 && i < lines; ++i)
      longest = std::max(longest, places[i + 1] - places[i]);
    const double length = places[k + 1] - places[k];
    const int spans = static_cast<int>(std::ceil(kSpansALine * length / longest - 1e-9));
    for (int i = k == 0 ? 1 : 0; i < spans; ++i) inner.push_back(places[k] + length * i / spans);
  }
  std::erase_if(inner, [&](double knot) { return knot <= from + 0.05 * places.back() / static_cast<double>(lines); });
  return inner;
}

TubeFit::Progress TubeFit::step() {
  if (!laid_) return Progress::None;
  if (!faster_) return smoothest();
  if (faster_->step()) return Progress::InWork;
  if (const auto& found = faster_->found()) {
    spline_.points = found->points;
    spline_.deviations = found->deviations_mm;
  }
  return Progress::Found;
}

TubeFit::Progress TubeFit::smoothest() {
  const auto& [polyline, before, tolerance_mm, widths_mm, limits, joints] = window_;
  if (!smoothest_in_tube(spline_.knots, polyline, widths_mm, before.kept_points(), spline_.points))
    return Progress::None;
  spline_.deviations = tube_distances(spline_.knots, spline_.points, polyline, tolerance_mm);
  const double part = largest_part(spline_.deviations, polyline, tolerance_mm);
  if (part > 1) {
    if (trials_++ == kTubeTrials || part > kFarOut) return Progress::None;
    for (double& width : window_.widths_mm) width *= 0.995 / part;
    return Progress::InWork;
  }
  if (limits.empty()) return Progress::Found;
  make_faster();
  return Progress::InWork;
}

void TubeFit::make_faster() {
  DraftLaw law(spline_.knots, window_.polyline, std::move(window_.limits), window_.joints);
  faster_ =
      std::make_unique<FasterInTube>(SplineInTube{spline_.knots, window_.polyline, window_.widths_mm,
                                                  window_.tolerance_mm, window_.before.kept_points(), spline_.points},
                                     std::move(law));
}

}  // namespace rmac
