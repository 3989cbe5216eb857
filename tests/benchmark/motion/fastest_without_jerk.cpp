#include "fastest_without_jerk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rmac::bench {
namespace {

/// Joints' first two derivatives by u, and the bound of (du/dt)², at one grid point.
struct Place {
  std::array<double, kMaxJoints> d1, d2;
  double cap;
};

Place place_at(const PathFunction& path, Real u, Real begin, Real end, const std::vector<JointLimits>& joints,
               double feed_mm_s) {
  const std::size_t n = joints.size();
  const Real h = 1e-4L * (end - begin);
  const Real middle = std::clamp(u, begin + h, end - h);
  std::array<Real, kMaxJoints + 3> below{}, here{}, above{};
  path(middle - h, below.data());
  path(middle, here.data());
  path(middle + h, above.data());
  Place place{};
  place.cap = 1e300;
  for (std::size_t j = 0; j < n; ++j) {
    const Real second = (above[j] - 2 * here[j] + below[j]) / (h * h);
    // Near the ends the stencil is moved inwards; the first derivative is carried back along the second.
    place.d1[j] = static_cast<double>((above[j] - below[j]) / (2 * h) + second * (u - middle));
    place.d2[j] = static_cast<double>(second);
    if (place.d1[j] != 0) place.cap = std::min(place.cap, std::pow(joints[j].max_speed / place.d1[j], 2));
  }
  Real tip = 0;
  for (std::size_t c = n; c < n + 3; ++c) tip += std::pow((above[c] - below[c]) / (2 * h), 2);
  place.cap = std::min(place.cap, feed_mm_s * feed_mm_s / static_cast<double>(tip));
  return place;
}

/// Bounds of the acceleration of u at (du/dt)² = q; empty when low > high.
struct Range {
  double low, high;
};
Range acceleration_range(const Place& place, double q, const std::vector<JointLimits>& joints) {
  Range range{-1e300, 1e300};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double a = joints[j].max_acceleration, bend = place.d2[j] * q, d = place.d1[j];
    if (std::abs(d) < 1e-9) {
      if (std::abs(bend) > a) return {1, 0};
      continue;
    }
    const double x = (-a - bend) / d, y = (a - bend) / d;
    range.low = std::max(range.low, std::min(x, y));
    range.high = std::min(range.high, std::max(x, y));
  }
  return range;
}

}  // namespace

double fastest_without_jerk_s(const PathFunction& path, Real begin, Real end, const std::vector<JointLimits>& joints,
                              double feed_mm_s, int grid) {
  const auto count = static_cast<std::size_t>(grid);
  const double step = static_cast<double>((end - begin) / grid);
  std::vector<Place> places;
  places.reserve(count + 1);
  for (int i = 0; i <= grid; ++i)
    places.push_back(place_at(path, begin + (end - begin) * i / grid, begin, end, joints, feed_mm_s));

  std::vector<double> reach(count + 1, 0.0);  // largest q from which the end can still be reached at rest
  for (std::size_t i = count; i-- > 0;) {
    const auto feasible = [&](double q) {
      const Range range = acceleration_range(places[i], q, joints);
      // The next q is q + 2 step u, which must lie in [0, reach of the next].
      const double low = std::max(range.low, -q / (2 * step));
      const double high = std::min(range.high, (reach[i + 1] - q) / (2 * step));
      return low <= high;
    };
    double yes = 0, no = places[i].cap;
    if (feasible(no)) yes = no;
    for (int k = 0; k < 100 && no - yes > 1e-13 * no; ++k) {
      const double middle = (yes + no) / 2;
      (feasible(middle) ? yes : no) = middle;
    }
    reach[i] = yes;
  }

  double q = 0, time = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Range range = acceleration_range(places[i], q, joints);
    const double next = std::clamp(q + 2 * step * range.high, 0.0, reach[i + 1]);
    time += 2 * step / (std::sqrt(q) + std::sqrt(next));
    q = next;
  }
  return time;
}

}  // namespace rmac::bench
