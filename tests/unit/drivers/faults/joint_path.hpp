#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace rmac::fault_test {

/// What a joint is to do: position, velocity and acceleration over its time in s, from where it stands.
class JointPath {
 public:
  struct Point {
    double position = 0, velocity = 0, acceleration = 0;
  };
  /// It stands.
  JointPath() = default;
  /// It speeds up to `speed` (either way) from `from_s` on, at most with `acceleration`, and brakes from `until_s` on.
  static JointPath go(double speed, double acceleration, double from_s, double until_s) {
    JointPath path;
    path.speed_ = speed;
    path.ramp_s_ = std::max(std::numbers::pi * std::abs(speed) / (2 * acceleration), 0.01);
    path.from_s_ = from_s;
    path.until_s_ = std::max(until_s, from_s + path.ramp_s_);
    return path;
  }
  /// It goes to and fro around where it stands, with the least speed at the ends.
  static JointPath swing(double amplitude, double rad_s, double from_s) {
    JointPath path;
    path.amplitude_ = amplitude;
    path.rad_s_ = rad_s;
    path.from_s_ = from_s;
    return path;
  }

  [[nodiscard]] Point at(double s) const {
    if (rad_s_ > 0) return swung(s);
    const Point up = ramp(s - from_s_), down = ramp(s - until_s_);
    return {up.position - down.position, up.velocity - down.velocity, up.acceleration - down.acceleration};
  }

 private:
  /// Of one that goes on for ever.
  [[nodiscard]] Point ramp(double s) const {
    if (s <= 0 || speed_ == 0) return {};
    const double w = std::numbers::pi / ramp_s_;
    if (s >= ramp_s_) return {speed_ * (s - ramp_s_ / 2), speed_, 0};
    return {speed_ / 2 * (s - std::sin(w * s) / w), speed_ / 2 * (1 - std::cos(w * s)),
            speed_ / 2 * w * std::sin(w * s)};
  }
  /// A sine that grows in half a period, so that it begins without a jump of the acceleration.
  [[nodiscard]] Point swung(double s) const {
    const double t = s - from_s_;
    if (t <= 0) return {};
    const double x = rad_s_ * t, grows = std::min(x / std::numbers::pi, 1.0);
    // Smooth: 3 g² - 2 g³ and its derivatives.
    const double g = grows * grows * (3 - 2 * grows),
                 g1 = grows < 1 ? 6 * grows * (1 - grows) * rad_s_ / std::numbers::pi : 0,
                 g2 = grows < 1 ? (6 - 12 * grows) * rad_s_ * rad_s_ / (std::numbers::pi * std::numbers::pi) : 0;
    const double sine = std::sin(x), cosine = std::cos(x);
    return {amplitude_ * g * sine, amplitude_ * (g1 * sine + g * rad_s_ * cosine),
            amplitude_ * (g2 * sine + 2 * g1 * rad_s_ * cosine - g * rad_s_ * rad_s_ * sine)};
  }

  double speed_ = 0, ramp_s_ = 1, from_s_ = 0, until_s_ = 0, amplitude_ = 0, rad_s_ = 0;
};

}  // namespace rmac::fault_test
