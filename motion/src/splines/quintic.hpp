#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rmac/motion/pose.hpp"
#include "splines/banded.hpp"

namespace rmac::quintic {

/// Splines of degree 5 in space as plain knots and control points, for the fits that look for them. Knots are simple
/// but for the ends. Curves that are travelled are `curves::SpaceCurve`s.
inline constexpr std::size_t kDegree = 5;

/// The six basis functions that live at a place, of control points `first` to `first` + 5.
struct Basis {
  std::size_t first = 0;
  std::array<double, kDegree + 1> values{};
};

/// Index of the knot that begins the span of x; `count` is the number of control points.
[[nodiscard]] std::size_t span_of(const std::vector<double>& knots, std::size_t count, double x);
/// The NURBS Book, A2.2.
[[nodiscard]] Basis basis(const std::vector<double>& knots, std::size_t count, double x);
/// Derivatives of the same functions, of order 1 to 5.
[[nodiscard]] Basis derivatives(const std::vector<double>& knots, std::size_t count, double x, std::size_t order);
/// A place in a span, as a part of it, and its share of an integral.
struct Quadrature {
  double place, share;
};
/// ∫ |S'''|² on a span is Σ share · span · |S'''|²: Gauss's of order 3, exact for a polynomial of degree 4.
inline constexpr std::array<Quadrature, 3> kThirdDerivativeSquared{
    Quadrature{0.1127016653792583, 5.0 / 18}, {0.5, 8.0 / 18}, {0.8872983346207417, 5.0 / 18}};
/// Adds weight · basis basisᵀ.
void add_square(const Basis& basis, double weight, Banded& matrix);
[[nodiscard]] Vector value(const Basis& basis, const std::vector<Vector>& points);
/// Length of each control point of the second derivative: on the span that begins with knot k, |S''| is at most the
/// largest of those from k - 5 to k - 2.
[[nodiscard]] std::vector<double> second_derivative_hull(const std::vector<double>& knots,
                                                         const std::vector<Vector>& points);

}  // namespace rmac::quintic
