#pragma once

#include <functional>
#include <random>

#include "rmac/motion/move.hpp"

namespace rmac::bench {

inline constexpr Vector kUp{0, 0, 1};

/// r = 30 + 10 cos 5θ, about the origin.
[[nodiscard]] Vector rose(double angle);
/// A butterfly of strong curvature (Fay, 1989), scaled into ±45 mm.
[[nodiscard]] Vector butterfly(double angle);

/// Corners of a polyline along a closed shape, each line as long as `line_mm` along the curve, begin and end included.
[[nodiscard]] std::vector<Vector> polyline(const std::function<Vector(double)>& shape, double angle, double line_mm);
/// The clamped spline of this degree that passes the shape at `count` angles spread evenly.
[[nodiscard]] Nurbs interpolated(const std::function<Vector(double)>& shape, double angle, int degree, int count);

/// Splines with poles uniform in 80 x 80 x 20 mm about the origin, degree 3 to 5, at least 100 mm long; with the axis
/// swinging up to 15 degrees where there are six coordinates.
class RandomSplines {
 public:
  explicit RandomSplines(unsigned seed) : random_(seed) {}
  [[nodiscard]] Nurbs three_axis() { return next(false); }
  [[nodiscard]] Nurbs five_axis() { return next(true); }
  /// Three axes; begins where the one before (of this function) ended, with equal tangent and curvature.
  [[nodiscard]] Nurbs in_stream(const Nurbs* before);
  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  [[nodiscard]] Nurbs next(bool with_axis);
  std::mt19937_64 random_;
};

/// A clamped spline with evenly spaced knots over these poles.
[[nodiscard]] Nurbs clamped(int degree, std::vector<std::vector<double>> poles);

}  // namespace rmac::bench
