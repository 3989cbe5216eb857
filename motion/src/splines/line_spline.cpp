#include "splines/line_spline.hpp"

#include <algorithm>

#include "splines/quintic.hpp"

namespace rmac {
namespace {

/// A quintic's span depends on five knots on either side.
constexpr std::size_t kKeptKnots = 2 * quintic::kDegree;

}  // namespace

double LineSpline::begin() const noexcept {
  return empty() ? 0 : knots[quintic::kDegree];
}

double LineSpline::free_from() const noexcept {
  return empty() ? 0 : knots[kKeptKnots - 1];
}

std::size_t LineSpline::kept_points() const noexcept {
  return empty() ? 1 : quintic::kDegree;
}

bool LineSpline::go_on(const LineSpline& before, const std::vector<double>& inner, const Polyline& polyline) {
  knots.assign(quintic::kDegree + 1, 0.0);
  if (!before.empty()) knots.assign(before.knots.begin(), before.knots.begin() + kKeptKnots);
  knots.insert(knots.end(), inner.begin(), inner.end());
  knots.insert(knots.end(), quintic::kDegree + 1, polyline.places.back());
  const std::size_t count = knots.size() - quintic::kDegree - 1;
  if (count < before.kept_points() + 2) return false;
  points.resize(count);
  points.front() = polyline.vertices.front();
  if (!before.empty()) std::copy_n(before.points.begin(), quintic::kDegree, points.begin());
  return true;
}

void LineSpline::leave(std::size_t knot, double place) {
  const auto kept = static_cast<std::ptrdiff_t>(knot - quintic::kDegree);
  knots.erase(knots.begin(), knots.begin() + kept);
  points.erase(points.begin(), points.begin() + kept);
  for (double& at : knots) at -= place;
  for (SplineSample& sample : samples) sample.place -= place;
}

}  // namespace rmac
