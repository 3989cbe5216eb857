#include <cmath>

#include "rmac/motion/time_law.hpp"

namespace rmac {
namespace {

/// cosh(√x), sinh(√x)/√x and (cosh(√x) - 1)/x for any sign of x (docs/derivations/time-law.md, eq. 5).
struct Stumpff {
  double c, s, d;
};

Stumpff stumpff(double x) noexcept {
  if (std::abs(x) < 0.1) {
    // Taylor series; the first term left out is below 1e-17 of the sum here.
    double c = 1, s = 1, d = 0.5, c_term = 1, s_term = 1, d_term = 0.5;
    for (int k = 1; k <= 7; ++k) {
      c_term *= x / ((2.0 * k - 1) * (2.0 * k));
      s_term *= x / ((2.0 * k) * (2.0 * k + 1));
      d_term *= x / ((2.0 * k + 1) * (2.0 * k + 2));
      c += c_term, s += s_term, d += d_term;
    }
    return {c, s, d};
  }
  if (x > 0) {
    const double w = std::sqrt(x);
    const double c = std::cosh(w);
    return {c, std::sinh(w) / w, (c - 1) / x};
  }
  const double w = std::sqrt(-x);
  const double c = std::cos(w);
  return {c, std::sin(w) / w, (c - 1) / x};
}

}  // namespace

PathState LawPiece::at(double t) const noexcept {
  const PathState& b = start;
  if (kind == Kind::Jerk) {
    return {b.s + t * (b.v + t * (b.a / 2 + t * slope / 6)), b.v + t * (b.a + t * slope / 2), b.a + t * slope};
  }
  const auto [c, s, d] = stumpff(slope * t * t);
  const double travelled = b.v * t * s + b.a * t * t * d;
  return {b.s + travelled, b.v * c + b.a * t * s, b.a + slope * travelled};
}

}  // namespace rmac
