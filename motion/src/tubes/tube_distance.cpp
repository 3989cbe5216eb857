#include <algorithm>
#include <cmath>

#include "curves/vector.hpp"
#include "splines/quintic.hpp"
#include "tubes/tube_spline.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;
using curves::distance;
using curves::dot;
using curves::unit;

constexpr int kMostHalvings = 10;
constexpr int kNewtonSteps = 4;

double distance_to_line(const Vector& p, const Vector& a, const Vector& b) {
  const Vector line = difference(b, a);
  const double part = std::clamp(dot(difference(p, a), line) / dot(line, line), 0.0, 1.0);
  return distance(p, along(a, part, line));
}

class TubeCheck {
 public:
  TubeCheck(const std::vector<double>& knots, const std::vector<Vector>& points, const Polyline& polyline, double most)
      : knots_(knots),
        points_(points),
        polyline_(polyline),
        most_(most),
        bends_(quintic::second_derivative_hull(knots, points)) {}

  /// From the spline's stretch of a line to the polyline: its bounds on pieces that are halved until they suffice.
  [[nodiscard]] double from_spline(std::size_t line) const {
    double largest = 0;
    const double most = most_ - polyline_.off_mm[line];
    double from = std::max(polyline_.places[line], knots_[quintic::kDegree]);
    const double to = polyline_.places[line + 1];
    while (from < to) {
      const std::size_t span = quintic::span_of(knots_, points_.size(), from);
      const double end = std::min(to, knots_[span + 1]);
      double bend = 0;
      for (std::size_t i = span - quintic::kDegree; i + 2 <= span; ++i) bend = std::max(bend, bends_[i]);
      largest = std::max(largest, on_piece({line, most, bend}, from, end, at(from), at(end), kMostHalvings));
      from = end;
    }
    return largest;
  }

  /// From a vertex to the spline, at the place where that passes it.
  [[nodiscard]] double from_vertex(std::size_t vertex) const {
    const double begin = knots_[quintic::kDegree], end = knots_[points_.size()];
    double place = polyline_.places[vertex];
    if (vertex == 0 || vertex == polyline_.lines() || place <= begin) return 0;
    const Vector& corner = polyline_.vertices[vertex];
    const Vector ahead = unit(along(unit(difference(corner, polyline_.vertices[vertex - 1])), 1,
                                    unit(difference(polyline_.vertices[vertex + 1], corner))));
    // The spline's parameter is about its length.
    for (int i = 0; i < kNewtonSteps; ++i)
      place = std::clamp(place - dot(ahead, difference(at(place), corner)), begin, end);
    return distance(at(place), corner);
  }

 private:
  [[nodiscard]] Vector at(double place) const {
    return quintic::value(quintic::basis(knots_, points_.size(), place), points_);
  }

  /// A piece is within h²/8 max |S''| of its chord, and distance to a line of the polyline is a convex function: on the
  /// chord no more than at its ends.
  struct Piece {
    std::size_t line = 0;
    double most = 0;
    double bend = 0;  ///< max |S''|
  };
  [[nodiscard]] double on_piece(const Piece& piece, double from, double to, const Vector& a, const Vector& b,
                                int halvings) const {
    const std::size_t line = piece.line;
    double bound = 1e30;
    if (line == 0 && polyline_.previous) {
      const Vector &start = *polyline_.previous, &end = polyline_.vertices[0];
      bound = std::max(distance_to_line(a, start, end), distance_to_line(b, start, end));
    }
    for (std::size_t k = line > 0 ? line - 1 : 0; k <= line + 1 && k < polyline_.lines(); ++k) {
      const Vector &start = polyline_.vertices[k], &end = polyline_.vertices[k + 1];
      bound = std::min(bound, std::max(distance_to_line(a, start, end), distance_to_line(b, start, end)));
    }
    bound += (to - from) * (to - from) / 8 * piece.bend;
    if (bound <= piece.most || halvings == 0) return bound;
    const double middle = 0.5 * (from + to);
    const Vector m = at(middle);
    const double left = on_piece(piece, from, middle, a, m, halvings - 1);
    if (left > piece.most) return left;
    return std::max(left, on_piece(piece, middle, to, m, b, halvings - 1));
  }

  const std::vector<double>& knots_;
  const std::vector<Vector>& points_;
  const Polyline& polyline_;
  double most_;
  std::vector<double> bends_;
};

}  // namespace

std::vector<double> tube_distances(const std::vector<double>& knots, const std::vector<Vector>& points,
                                   const Polyline& polyline, double most_mm) {
  const TubeCheck check(knots, points, polyline, most_mm);
  std::vector<double> distances;
  for (std::size_t k = 0; k < polyline.lines(); ++k)
    distances.push_back(std::max({check.from_spline(k), check.from_vertex(k), check.from_vertex(k + 1)}));
  return distances;
}

double largest_part(const std::vector<double>& distances, const Polyline& polyline, double most_mm) {
  double part = 0;
  for (std::size_t k = 0; k < distances.size(); ++k)
    part = std::max(part, distances[k] / (most_mm - polyline.off_mm[k]));
  return part;
}

}  // namespace rmac
