#pragma once

#include <cstddef>
#include <vector>

namespace rmac {

/// A rational B-spline curve as it comes from a client (Piegl & Tiller, The NURBS Book, ch. 4): data only, unchecked.
/// `points[i]` has `dimension` coordinates; `weights` is empty (all one) or as long as `points`;
/// `knots` is flat, of length points + degree + 1. A periodic curve is given in its unwound form.
struct Nurbs {
  int degree = 3;
  std::size_t dimension = 3;
  std::vector<double> knots;
  std::vector<std::vector<double>> points;
  std::vector<double> weights;
};

}  // namespace rmac
