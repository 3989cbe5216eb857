#include "nurbs_check.hpp"

#include <algorithm>

#include "bspline.hpp"
#include "build.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::curves {
namespace {

/// Beyond these the arithmetic loses the digits that a path needs.
constexpr double kLargestCoordinate = 1e7;
constexpr double kLargestWeightRatio = 1e9;
constexpr double kSmallestSpan = 1e-12;

std::string item(const char* what, std::size_t index, double value) {
  return std::string(what) + " " + std::to_string(index) + " (" + text(value) + ")";
}

Expected<> check_shape(const Nurbs& nurbs, NurbsSpace space, std::size_t joint_count) {
  if (nurbs.degree < 1 || nurbs.degree > static_cast<int>(kMaxDegree)) {
    return refuse("the NURBS has degree " + std::to_string(nurbs.degree) + "; 1 to " + std::to_string(kMaxDegree) +
                  " are possible");
  }
  const auto degree = static_cast<std::size_t>(nurbs.degree);
  const std::size_t dimension = space == NurbsSpace::Tip ? 3 : space == NurbsSpace::Pose ? 6 : joint_count;
  if (nurbs.dimension != dimension || dimension == 0 || dimension > kMaxJoints) {
    const char* const rule = space == NurbsSpace::Tip    ? "a tip curve has x y z"
                             : space == NurbsSpace::Pose ? "a pose curve has x y z i j k"
                                                         : "a joint curve has one a joint";
    return refuse("the NURBS has " + std::to_string(nurbs.dimension) + " coordinates a point; " + rule + ", here " +
                  std::to_string(dimension));
  }
  if (nurbs.points.size() < degree + 1) {
    return refuse("the NURBS has " + std::to_string(nurbs.points.size()) + " points; degree " + std::to_string(degree) +
                  " needs at least " + std::to_string(degree + 1));
  }
  if (nurbs.knots.size() != nurbs.points.size() + degree + 1) {
    return refuse("the NURBS has " + std::to_string(nurbs.knots.size()) + " knots; " +
                  std::to_string(nurbs.points.size()) + " points of degree " + std::to_string(degree) + " need " +
                  std::to_string(nurbs.points.size() + degree + 1) + " (points + degree + 1)");
  }
  if (!nurbs.weights.empty() && nurbs.weights.size() != nurbs.points.size()) {
    return refuse("the NURBS has " + std::to_string(nurbs.weights.size()) + " weights for " +
                  std::to_string(nurbs.points.size()) + " points; give one a point, or none");
  }
  return {};
}

Expected<> check_points(const Nurbs& nurbs) {
  for (std::size_t i = 0; i < nurbs.points.size(); ++i) {
    const auto& point = nurbs.points[i];
    if (point.size() != nurbs.dimension) {
      return refuse("the NURBS' point " + std::to_string(i) + " has " + std::to_string(point.size()) +
                    " coordinates instead of " + std::to_string(nurbs.dimension));
    }
    for (const double c : point) {
      if (!std::isfinite(c))
        return refuse("the NURBS' point " + std::to_string(i) + " holds a number that is not finite");
      if (std::abs(c) > kLargestCoordinate) {
        return refuse("the NURBS' " + item("point", i, c) + " lies further than " + text(kLargestCoordinate) + " away");
      }
    }
  }
  for (std::size_t i = 0; i < nurbs.weights.size(); ++i) {
    const double weight = nurbs.weights[i];
    if (!std::isfinite(weight) || weight <= 0) {
      return refuse("the NURBS' " + item("weight", i, weight) + " is not a positive number");
    }
  }
  if (!nurbs.weights.empty()) {
    const auto [least, most] = std::minmax_element(nurbs.weights.begin(), nurbs.weights.end());
    if (*most > kLargestWeightRatio * *least) {
      return refuse("the NURBS' weights differ by the factor " + text(*most / *least) + "; at most " +
                    text(kLargestWeightRatio) + " keeps the curve's digits");
    }
  }
  return {};
}

Expected<> check_knots(const Nurbs& nurbs) {
  const auto& knots = nurbs.knots;
  const auto degree = static_cast<std::size_t>(nurbs.degree);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i])) return refuse("the NURBS' knot " + std::to_string(i) + " is not a finite number");
    if (i > 0 && knots[i] < knots[i - 1]) {
      return refuse("the NURBS' " + item("knot", i, knots[i]) + " is less than " + item("knot", i - 1, knots[i - 1]) +
                    "; knots must not decrease");
    }
  }
  const double first = knots[degree];
  const double last = knots[nurbs.points.size()];
  if (!(last > first) || !std::isfinite(last - first)) {
    return refuse("the NURBS' knots leave no range to run over: " + item("knot", degree, first) + " to " +
                  item("knot", nurbs.points.size(), last));
  }
  std::size_t times = 1;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double step = (knots[i] - knots[i - 1]) / (last - first);
    times = step > 0 ? 1 : times + 1;
    const bool inside = knots[i] > first && knots[i] < last;
    const std::size_t allowed = inside ? degree : degree + 1;
    if (times > allowed) {
      return refuse("the NURBS' " + item("knot", i, knots[i]) + " occurs more than " + std::to_string(allowed) +
                    " times; the curve of degree " + std::to_string(degree) +
                    (inside ? " would come apart there" : " would leave points unused there"));
    }
    if (step > 0 && step < kSmallestSpan) {
      return refuse("the NURBS' " + item("knot", i, knots[i]) + " and the one before differ by " +
                    text(knots[i] - knots[i - 1]) + ", too little for their range; make them equal");
    }
  }
  return {};
}

}  // namespace

Expected<> check_nurbs(const NurbsGeometry& geometry, std::size_t joint_count) {
  if (auto sound = check_shape(geometry.curve, geometry.space, joint_count); !sound) return sound;
  if (auto sound = check_points(geometry.curve); !sound) return sound;
  return check_knots(geometry.curve);
}

}  // namespace rmac::curves
