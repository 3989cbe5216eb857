#include <array>
#include <cmath>

#include "rmac/motion/time_law.hpp"

namespace rmac {
namespace {

/// cosh(√x), sinh(√x)/√x and (cosh(√x) - 1)/x for any sign of x (docs/derivations/time-law.md, eq. 5).
struct Stumpff {
  double c, s, d;
};

constexpr std::size_t kTerms = 7;
constexpr auto kInverseFactorial = [] {
  std::array<double, 2 * kTerms + 1> inverse{};
  double factorial = 1;
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1 / (factorial *= static_cast<double>(k));
  return inverse;
}();

Stumpff stumpff(double x) noexcept {
  if (std::abs(x) < 0.1) {
    // Taylor series; the first term left out is below 1e-17 of the sum here.
    double s = kInverseFactorial[2 * kTerms - 1], d = kInverseFactorial[2 * kTerms];
    for (std::size_t k = kTerms - 1; k > 0; --k) {
      s = s * x + kInverseFactorial[2 * k - 1];
      d = d * x + kInverseFactorial[2 * k];
    }
    return {1 + x * d, s, d};
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
