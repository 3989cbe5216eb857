#include "short_lines/turn_spline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curves/vector.hpp"
#include "short_lines/turning_curve.hpp"
#include "splines/banded.hpp"
#include "splines/quintic.hpp"

namespace rmac {
namespace {

using curves::difference;
using curves::dot;
using quintic::Basis;
using quintic::kDegree;

/// Knots are not nearer to each other than this.
constexpr double kLeastStep_mm = 0.03;

/// min Σ over joints of ∫ |θ'''|² + Σ share w⁻⁶ rate² (θ - asked)².
class SmoothTurns {
 public:
  explicit SmoothTurns(const TurningLines& lines)
      : lines_(lines), turns_(rotary_joints(lines.map->kinematics()).size()) {}

  std::optional<double> solve(std::size_t kept, LineSpline& trial) const {
    const std::size_t count = trial.knots.size() - kDegree - 1;
    std::vector<Basis> at_samples, third;
    std::vector<double> shares;
    for (const SplineSample& sample : trial.samples)
      at_samples.push_back(quintic::basis(trial.knots, count, sample.place));
    for (std::size_t i = kDegree; i < count; ++i) {
      const double begin = trial.knots[i], width = trial.knots[i + 1] - begin;
      for (const auto& [part, share] : quintic::kThirdDerivativeSquared) {
        third.push_back(quintic::derivatives(trial.knots, count, begin + width * part, 3));
        shares.push_back(share * width);
      }
    }
    for (std::size_t turn = 0; turn < turns_; ++turn) {
      Banded matrix(count, kDegree);
      std::vector<double> right(count, 0.0);
      for (std::size_t k = 0; k < at_samples.size(); ++k) {
        const SplineSample& sample = trial.samples[k];
        const double weight = sample.share * weight_of(sample, lines_.rates[k][turn]);
        quintic::add_square(at_samples[k], weight, matrix);
        for (std::size_t a = 0; a <= kDegree; ++a)
          right[at_samples[k].first + a] += weight * at_samples[k].values[a] * sample.point[turn];
      }
      for (std::size_t g = 0; g < third.size(); ++g) quintic::add_square(third[g], shares[g], matrix);
      for (std::size_t i = 0; i < kept; ++i) matrix.fix(i, trial.points[i][turn], right);
      matrix.fix(count - 1, trial.samples.back().point[turn], right);
      if (!matrix.factorise()) return std::nullopt;
      matrix.substitute(right);
      for (std::size_t i = kept; i < count; ++i) trial.points[i][turn] = right[i];
    }
    measure(at_samples, trial);
    double roughness = 0;
    for (std::size_t g = 0; g < third.size(); ++g) {
      const Vector value = quintic::value(third[g], trial.points);
      roughness += shares[g] * dot(value, value);
    }
    return roughness;
  }

 private:
  /// Where a joint hardly turns the axis it is smoothed by no more than the widest, so that what comes behind it hardly
  /// shapes what goes before, nor swings it out; where the lines hardly know where it stands, by as much as it likes.
  [[nodiscard]] static double weight_of(const SplineSample& sample, double rate) {
    const auto sixth = [](double w) { return 1 / (w * w * w * w * w * w); };
    const double known = std::min(1.0, rate / kUnknownRate);
    return std::max(sixth(sample.width_mm) * rate * rate, sixth(sample.most_mm) * known * known);
  }

  /// By how much the axis is off at the samples, and may be between them: by h²/8 of how it bends.
  void measure(const std::vector<Basis>& at_samples, LineSpline& trial) const {
    auto& samples = trial.samples;
    const std::size_t count = samples.size();
    std::vector<Vector> axes;
    std::vector<double> off, bends(count, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      axes.push_back(axis_of_turns(*lines_.map, quintic::value(at_samples[k], trial.points).data()));
      off.push_back(curves::distance(axes[k], lines_.axes[k]));
    }
    const auto step = [&](std::size_t k) { return samples[k + 1].place - samples[k].place; };
    for (std::size_t k = 1; k + 1 < count; ++k) {
      const Vector before = curves::scaled(1 / step(k - 1), difference(axes[k], axes[k - 1]));
      const Vector after = curves::scaled(1 / step(k), difference(axes[k + 1], axes[k]));
      bends[k] = 2 * curves::distance(after, before) / (step(k - 1) + step(k));
    }
    constexpr double kMore = 1.2;  // it may bend more between samples than at them
    for (std::size_t k = 0; k + 1 < count; ++k) {
      const double h = step(k);
      samples[k].off = std::max(off[k], off[k + 1]) + kMore * h * h / 8 * std::max(bends[k], bends[k + 1]);
    }
    samples.back().off = off.back();
  }

  const TurningLines& lines_;
  std::size_t turns_;
};

}  // namespace

std::optional<LineSpline> smoothest_turns(const TurningLines& lines, const TurnBounds& bounds,
                                          const LineSpline& before) {
  DenseLines window{lines.joints, bounds.tolerance_rad, bounds.tolerance_rad, bounds.overlap_mm};
  window.start_corner_mm = bounds.start_corner_mm;
  window.end_corner_mm = bounds.end_corner_mm;
  window.knot_at = bounds.knot_at;
  window.least_step_mm = kLeastStep_mm;
  const SmoothTurns smooth(lines);
  auto spline = smoothest_within(window, before, lines.samples,
                                 [&](LineSpline& trial) { return smooth.solve(before.kept_points(), trial); });
  if (!spline) return std::nullopt;
  return *std::move(spline);
}

LineSpline resting_turns(const PathSegment& line) {
  constexpr double kStep_mm = 0.5;
  LineSpline rest;
  for (int i = 0; i < 2 * static_cast<int>(kDegree) + 2; ++i)
    rest.knots.push_back(kStep_mm * (i - static_cast<int>(kDegree)));
  Vector joints{};
  std::size_t turn = 0;
  for (const std::size_t j : rotary_joints(line.map()->kinematics())) joints[turn++] = line.joints_at_node(0)[j];
  rest.points.assign(kDegree + 1, joints);
  return rest;
}

}  // namespace rmac
