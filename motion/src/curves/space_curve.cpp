#include <algorithm>
#include <cmath>
#include <numbers>

#include "nurbs_curve.hpp"

namespace rmac::curves {
namespace {

/// An axis of which the length falls below this has no direction that the client could have meant.
constexpr double kLeastAxis = 1e-6;

double product(const CurvePoint& point, std::size_t a, std::size_t b, std::size_t first, std::size_t last) noexcept {
  const auto &x = point.d[a], &y = point.d[b];
  if (last - first == 3) return x[first] * y[first] + x[first + 1] * y[first + 1] + x[first + 2] * y[first + 2];
  double sum = 0;
  for (std::size_t c = first; c < last; ++c) sum += x[c] * y[c];
  return sum;
}

/// Coordinates 3 to 5 divided by their length, with derivatives (docs/derivations/curves.md, eq. 6 and 7).
void normalize_axis(int order, CurvePoint& point) noexcept {
  const auto n = [&](std::size_t a, std::size_t b) { return product(point, a, b, 3, 6); };
  std::array<double, 4> r{};
  r[0] = std::sqrt(n(0, 0));
  if (order >= 1) r[1] = n(0, 1) / r[0];
  if (order >= 2) r[2] = (n(1, 1) + n(0, 2) - r[1] * r[1]) / r[0];
  if (order >= 3) r[3] = (3 * n(1, 2) + n(0, 3) - 3 * r[1] * r[2]) / r[0];
  for (std::size_t c = 3; c < 6; ++c) {
    point.d[0][c] /= r[0];
    if (order >= 1) point.d[1][c] = (point.d[1][c] - r[1] * point.d[0][c]) / r[0];
    if (order >= 2) point.d[2][c] = (point.d[2][c] - 2 * r[1] * point.d[1][c] - r[2] * point.d[0][c]) / r[0];
    if (order >= 3) {
      point.d[3][c] =
          (point.d[3][c] - 3 * r[1] * point.d[2][c] - 3 * r[2] * point.d[1][c] - r[3] * point.d[0][c]) / r[0];
    }
  }
}

}  // namespace

SpaceCurve::SpaceCurve(const Nurbs& nurbs, NurbsSpace space, const Vector& held_axis)
    : spline_(nurbs), space_(space), held_axis_(held_axis) {
  if (space_ == NurbsSpace::Joint) last_ = spline_.dimension();
  rests_ = spline_.extent(first_, last_) <= kZeroLength_mm;
  if (rests_ && space_ == NurbsSpace::Pose && spline_.extent(3, 6) > kStartTolerance_axis) {
    first_ = 3;
    last_ = 6;
    unit_ = 180 / std::numbers::pi;
    rests_ = false;
  }
  extent_ = spline_.extent(first_, last_);
}

void SpaceCurve::evaluate(std::size_t span, double t, int order, CurvePoint& point) const noexcept {
  spline_.evaluate(span, t, order, point);
  if (space_ == NurbsSpace::Pose) normalize_axis(order, point);
  if (space_ == NurbsSpace::Tip) {
    std::copy_n(held_axis_.begin(), 3, point.d[0].begin() + 3);
    for (std::size_t k = 1; k <= static_cast<std::size_t>(order); ++k) std::fill_n(point.d[k].begin() + 3, 3, 0.0);
  }
}

inline double SpaceCurve::product(const CurvePoint& point, std::size_t a, std::size_t b) const noexcept {
  return curves::product(point, a, b, first_, last_) * unit_ * unit_;
}

inline double SpaceCurve::speed(const CurvePoint& point) const noexcept {
  return std::sqrt(product(point, 1, 1));
}

double SpaceCurve::speed(std::size_t span, double t) const noexcept {
  CurvePoint point;
  if (space_ == NurbsSpace::Pose && first_ == 3) {
    evaluate(span, t, 1, point);  // the axis is normalised first
  } else {
    spline_.differentiate(span, t, point);
  }
  return speed(point);
}

void SpaceCurve::to_arc_length(int order, CurvePoint& point) const noexcept {
  if (order < 1) return;
  const double inverse = 1 / speed(point);
  const double t1 = inverse;
  double t2 = 0;
  double t3 = 0;
  if (order >= 2) {
    const double v1 = product(point, 1, 2) * inverse;
    t2 = -v1 * inverse * inverse * inverse;
    if (order >= 3) {
      const double v2 = (product(point, 2, 2) + product(point, 1, 3) - v1 * v1) * inverse;
      const double square = inverse * inverse;
      t3 = (3 * v1 * v1 * inverse - v2) * square * square;
    }
  }
  // An axis that is held stays as it is.
  const std::size_t moving = space_ == NurbsSpace::Tip ? 3 : dimension();
  for (std::size_t c = 0; c < moving; ++c) {
    auto& d = point.d;
    if (order >= 3) d[3][c] = d[3][c] * t1 * t1 * t1 + 3 * d[2][c] * t1 * t2 + d[1][c] * t3;
    if (order >= 2) d[2][c] = d[2][c] * t1 * t1 + d[1][c] * t2;
    d[1][c] *= t1;
  }
}

void SpaceCurve::tangent(std::size_t span, double t, CurvePoint& point) const noexcept {
  evaluate(span, t, 1, point);
  to_arc_length(1, point);
}

double SpaceCurve::least_speed(std::size_t span) const noexcept {
  // A span in which the points differ by their last digits only: what is left of the speed is rounding.
  return 1e-12 * extent_ * unit_ / spline_.span_width(span);
}

bool SpaceCurve::stays(std::size_t span) const {
  const auto alike = [&](std::size_t first, std::size_t last, double most) {
    const std::vector<double> begin = spline_.control_point(span, 0, first, last);
    for (std::size_t i = 1; i <= spline_.degree(); ++i) {
      const std::vector<double> here = spline_.control_point(span, i, first, last);
      for (std::size_t c = 0; c < here.size(); ++c) {
        if (!(std::abs(here[c] - begin[c]) <= most)) return false;
      }
    }
    return true;
  };
  return alike(first_, last_, kZeroLength_mm) && (space_ != NurbsSpace::Pose || alike(3, 6, kStartTolerance_axis));
}

bool SpaceCurve::straight(std::size_t span) const {
  if (unit_ != 1) return false;  // the tool axis measures the length
  const std::size_t degree = spline_.degree();
  const auto point = [&](std::size_t i) { return spline_.control_point(span, i, first_, last_); };
  const std::vector<double> begin = point(0);
  const std::vector<double> end = point(degree);
  double length = 0;
  for (std::size_t c = 0; c < begin.size(); ++c) length = std::hypot(length, end[c] - begin[c]);
  if (length <= kZeroLength_mm) return false;
  double reached = 0;
  for (std::size_t i = 1; i <= degree; ++i) {
    const std::vector<double> here = point(i);
    double ahead = 0;
    for (std::size_t c = 0; c < here.size(); ++c) ahead += (here[c] - begin[c]) * (end[c] - begin[c]) / length;
    double aside = 0;
    for (std::size_t c = 0; c < here.size(); ++c) {
      aside = std::hypot(aside, here[c] - begin[c] - ahead * (end[c] - begin[c]) / length);
    }
    if (aside > kZeroLength_mm || ahead < reached - kZeroLength_mm) return false;
    reached = ahead;
  }
  if (space_ != NurbsSpace::Pose) return true;
  const std::vector<double> axis = spline_.control_point(span, 0, 3, 6);
  for (std::size_t i = 1; i <= degree; ++i) {
    const std::vector<double> other = spline_.control_point(span, i, 3, 6);
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::abs(other[c] - axis[c]) > kStartTolerance_axis) return false;
    }
  }
  return true;
}

std::optional<LengthTable::Place> SpaceCurve::vanishing_axis() const {
  if (space_ != NurbsSpace::Pose) return std::nullopt;
  LengthTable::Place place;
  for (std::size_t span = 0; span < spline_.span_count(); ++span) {
    if (axis_vanishes(span, 0, spline_.span_width(span), 0, place)) return place;
  }
  return std::nullopt;
}

bool SpaceCurve::axis_vanishes(std::size_t span, double from, double to, int depth, LengthTable::Place& place) const {
  CurvePoint middle;
  CurvePoint begin;
  CurvePoint end;
  const double t = from + (to - from) / 2;
  spline_.evaluate(span, t, 1, middle);
  spline_.evaluate(span, from, 1, begin);
  spline_.evaluate(span, to, 1, end);
  const auto length = [](const CurvePoint& point, std::size_t k) {
    return std::sqrt(curves::product(point, k, k, 3, 6));
  };
  const double here = length(middle, 0);
  if (std::min({here, length(begin, 0), length(end, 0)}) < kLeastAxis || depth > 40) {
    place = {span, t};
    return true;
  }
  // Half an interval at the sum of three rates bounds what the axis can lose from its middle on.
  if (here > (length(begin, 1) + length(middle, 1) + length(end, 1)) * (to - from) / 2) return false;
  return axis_vanishes(span, from, t, depth + 1, place) || axis_vanishes(span, t, to, depth + 1, place);
}

}  // namespace rmac::curves
