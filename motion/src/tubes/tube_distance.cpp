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
    Stretch stretch{line, most_ - polyline_.off_mm[line]};
    double from = std::max(polyline_.places[line], knots_[quintic::kDegree]);
    const double to = polyline_.places[line + 1];
    while (from < to) {
      const std::size_t span = quintic::span_of(knots_, points_.size(), from);
      const double end = std::min(to, knots_[span + 1]);
      stretch.bend = 0;
      for (std::size_t i = span - quintic::kDegree; i + 2 <= span; ++i)
        stretch.bend = std::max(stretch.bend, bends_[i]);
      measure(stretch, {from, at(from)}, {end, at(end)}, kMostHalvings);
      from = end;
    }
    return stretch.bound;
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

  /// The spline along one line of the polyline, and what is known of its distance.
  struct Stretch {
    std::size_t line = 0;
    double most = 0;   ///< what suffices
    double bend = 0;   ///< max |S''| of the span that is looked at
    double seen = 0;   ///< the largest distance of a place
    double bound = 0;  ///< no place is further away
  };
  struct Place {
    double at = 0;
    Vector point;
  };

  /// A piece is within h²/8 max |S''| of its chord, and distance to a line of the polyline is a convex function: on the
  /// chord no more than at its ends. Halved until that suffices, or hardly exceeds the largest distance seen: how far
  /// out the spline is says how much narrower the tube has to be.
  void measure(Stretch& stretch, const Place& a, const Place& b, int halvings) const {
    constexpr double kHardly = 1.002;
    const std::size_t line = stretch.line;
    double chord = 1e30, nearest_a = 1e30, nearest_b = 1e30;
    const auto take = [&](const Vector& start, const Vector& end) {
      const double at_a = distance_to_line(a.point, start, end), at_b = distance_to_line(b.point, start, end);
      chord = std::min(chord, std::max(at_a, at_b));
      nearest_a = std::min(nearest_a, at_a);
      nearest_b = std::min(nearest_b, at_b);
    };
    if (line == 0 && polyline_.previous) take(*polyline_.previous, polyline_.vertices[0]);
    for (std::size_t k = line > 0 ? line - 1 : 0; k <= line + 1 && k < polyline_.lines(); ++k)
      take(polyline_.vertices[k], polyline_.vertices[k + 1]);
    const double length = b.at - a.at, bound = chord + length * length / 8 * stretch.bend;
    stretch.seen = std::max({stretch.seen, nearest_a, nearest_b});
    const bool outside = stretch.seen > stretch.most;
    if (halvings == 0 || bound <= (outside ? kHardly * stretch.seen : stretch.most)) {
      stretch.bound = std::max(stretch.bound, bound);
      return;
    }
    const double middle = 0.5 * (a.at + b.at);
    const Place m{middle, at(middle)};
    measure(stretch, a, m, halvings - 1);
    measure(stretch, m, b, halvings - 1);
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
