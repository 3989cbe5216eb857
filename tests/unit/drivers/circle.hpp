#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace rmac::mill_test {

/// A circle in the plane of the first two joints, as in the test of ISO 230-4: from rest at (radius, 0), round more
/// than once, and to rest; the turn in the middle counts.
class Circle {
 public:
  Circle(double radius, double feed, double acceleration, double jerk) : radius_(radius), feed_(feed) {
    jerk_time_ = std::min(acceleration / jerk, std::sqrt(feed / jerk));
    jerk_ = jerk;
    ramp_time_ = feed / (jerk * jerk_time_) + jerk_time_;
  }

  struct Point {
    std::array<double, 2> position{}, velocity{}, acceleration{};
  };
  /// Where to be `t` after the start; runs up to the feed and then round for ever.
  [[nodiscard]] Point at(double t) const {
    double s = 0, v = 0, a = 0;
    const double cruise = ramp_time_ - 2 * jerk_time_;
    for (const auto& [length, j] : {std::pair{jerk_time_, jerk_}, {cruise, 0.0}, {jerk_time_, -jerk_}, {1e9, 0.0}}) {
      const double d = std::clamp(t, 0.0, length);
      s += v * d + a * d * d / 2 + j * d * d * d / 6;
      v += a * d + j * d * d / 2;
      a += j * d;
      t -= d;
    }
    const double angle = s / radius_;
    const double c = std::cos(angle), n = std::sin(angle);
    const double w = v / radius_, dw = a / radius_;
    return {{radius_ * c - radius_, radius_ * n},
            {-radius_ * w * n, radius_ * w * c},
            {-radius_ * (dw * n + w * w * c), radius_ * (dw * c - w * w * n)}};
  }
  [[nodiscard]] double turn_s() const { return 2 * std::numbers::pi * radius_ / feed_; }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  double radius_, feed_, jerk_ = 0, jerk_time_ = 0, ramp_time_ = 0;
};

/// What a ballbar would draw: radial deviations over one turn, mm.
class Ballbar {
 public:
  explicit Ballbar(double radius) : radius_(radius) {}

  /// A measured point, in the circle's own coordinates (it starts at the origin, its centre at (-radius, 0)).
  void add(double x, double y) {
    const double from_centre = std::hypot(x + radius_, y);
    points_.push_back({std::atan2(y, x + radius_), from_centre - radius_});
  }
  /// Largest radial deviation.
  [[nodiscard]] double contour_error() const {
    double largest = 0;
    for (const auto& [angle, deviation] : points_) largest = std::max(largest, std::abs(deviation));
    return largest;
  }
  /// Root of the mean square of the radial deviation.
  [[nodiscard]] double contour_rms() const {
    double sum = 0;
    for (const auto& [angle, deviation] : points_) sum += deviation * deviation;
    return points_.empty() ? 0 : std::sqrt(sum / static_cast<double>(points_.size()));
  }
  /// Largest departure, within 8 degrees after an axis turns round, from the mean of the 8 degrees before.
  [[nodiscard]] double reversal_spike() const {
    constexpr double kWindow = 8 * std::numbers::pi / 180;
    double largest = 0;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
      double sum = 0;
      int count = 0;
      const auto after = [&](double angle) {
        return std::remainder(angle - quadrant * std::numbers::pi / 2, 2 * std::numbers::pi);
      };
      for (const auto& [angle, deviation] : points_) {
        if (after(angle) < 0 && after(angle) > -kWindow) sum += deviation, ++count;
      }
      for (const auto& [angle, deviation] : points_) {
        if (after(angle) < 0 || after(angle) > kWindow || count == 0) continue;
        largest = std::max(largest, std::abs(deviation - sum / count));
      }
    }
    return largest;
  }

 private:
  double radius_;
  std::vector<std::pair<double, double>> points_;
};

}  // namespace rmac::mill_test
