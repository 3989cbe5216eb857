#include "splines/smoothing_spline.hpp"

#include <algorithm>
#include <cmath>

#include "curves/vector.hpp"
#include "splines/banded.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;

}  // namespace

SmoothingSpline::SmoothingSpline(const std::vector<double>& knots, std::vector<SplineSample>& samples)
    : knots_(knots), samples_(samples) {
  const std::size_t count = knots.size() - quintic::kDegree - 1;
  for (const SplineSample& sample : samples) at_samples_.push_back(quintic::basis(knots, count, sample.place));
  for (std::size_t i = quintic::kDegree; i < count; ++i) {
    for (const auto& [part, share] : quintic::kThirdDerivativeSquared)
      third_.push_back(quintic::derivatives(knots, count, knots[i] + (knots[i + 1] - knots[i]) * part, 3));
  }
}

bool SmoothingSpline::solve(std::size_t kept, std::vector<Vector>& points) {
  const std::size_t count = knots_.size() - quintic::kDegree - 1;
  // About the first sample, so that no digits are lost far from the origin.
  const Vector origin = samples_.front().point;
  Banded matrix(count, quintic::kDegree);
  std::vector<Vector> right(count, Vector{});
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const SplineSample& sample = samples_[k];
    const double cube = sample.width_mm * sample.width_mm * sample.width_mm;
    const double weight = sample.share / (cube * cube);
    quintic::add_square(at_samples_[k], weight, matrix);
    const Vector target = curves::scaled(weight, difference(sample.point, origin));
    for (std::size_t a = 0; a <= quintic::kDegree; ++a) {
      Vector& row = right[at_samples_[k].first + a];
      row = along(row, at_samples_[k].values[a], target);
    }
  }
  for (std::size_t g = 0; g < third_.size(); ++g) {
    const std::size_t span = quintic::kDegree + g / quintic::kThirdDerivativeSquared.size();
    const double share = quintic::kThirdDerivativeSquared[g % quintic::kThirdDerivativeSquared.size()].share;
    quintic::add_square(third_[g], share * (knots_[span + 1] - knots_[span]), matrix);
  }
  for (std::size_t i = 0; i < kept; ++i) matrix.fix(i, difference(points[i], origin), right);
  matrix.fix(count - 1, difference(samples_.back().point, origin), right);
  if (!matrix.factorise()) return false;
  matrix.substitute(right);
  for (std::size_t i = kept; i < count; ++i) points[i] = along(origin, 1, right[i]);
  measure(points);
  return true;
}

double SmoothingSpline::roughness(const std::vector<Vector>& points) const {
  double sum = 0;
  for (std::size_t g = 0; g < third_.size(); ++g) {
    const std::size_t span = quintic::kDegree + g / quintic::kThirdDerivativeSquared.size();
    const double share = quintic::kThirdDerivativeSquared[g % quintic::kThirdDerivativeSquared.size()].share;
    const Vector third = quintic::value(third_[g], points);
    sum += share * (knots_[span + 1] - knots_[span]) * curves::dot(third, third);
  }
  return sum;
}

void SmoothingSpline::measure(const std::vector<Vector>& points) {
  const auto off = [&](std::size_t k) {
    return curves::distance(quintic::value(at_samples_[k], points), samples_[k].point);
  };
  const std::vector<double> bends = quintic::second_derivative_hull(knots_, points);
  double here = off(0);
  for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
    const double there = off(k + 1), h = samples_[k + 1].place - samples_[k].place;
    double bend = 0;
    for (std::size_t i = at_samples_[k].first; i + 2 <= at_samples_[k + 1].first + quintic::kDegree; ++i)
      bend = std::max(bend, bends[i]);
    samples_[k].off = std::max(here, there) + h * h / 8 * bend;
    here = there;
  }
  samples_.back().off = here;
}

}  // namespace rmac
