#include "exact_nurbs.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::bench {

ExactNurbs::ExactNurbs(const Nurbs& nurbs)
    : degree_(static_cast<std::size_t>(nurbs.degree)), dimension_(nurbs.dimension), levels_(3) {
  Level& curve = levels_[0];
  curve.degree = degree_;
  curve.knots.assign(nurbs.knots.begin(), nurbs.knots.end());
  for (std::size_t i = 0; i < nurbs.points.size(); ++i) {
    const Real weight = nurbs.weights.empty() ? 1 : nurbs.weights[i];
    RealPoint point;
    for (std::size_t c = 0; c < dimension_; ++c) point.push_back(weight * nurbs.points[i][c]);
    point.push_back(weight);
    curve.points.push_back(point);
  }
  for (std::size_t k = 1; k < levels_.size(); ++k) {
    const Level& above = levels_[k - 1];
    Level& level = levels_[k];
    if (above.degree == 0) {
      level = above;
      for (RealPoint& point : level.points) std::fill(point.begin(), point.end(), Real{0});
      continue;
    }
    level.degree = above.degree - 1;
    level.knots.assign(above.knots.begin() + 1, above.knots.end() - 1);
    for (std::size_t i = 0; i + 1 < above.points.size(); ++i) {
      const Real support = above.knots[i + above.degree + 1] - above.knots[i + 1];
      RealPoint point(dimension_ + 1, 0);
      for (std::size_t c = 0; c <= dimension_ && support > 0; ++c)
        point[c] = static_cast<Real>(above.degree) * (above.points[i + 1][c] - above.points[i][c]) / support;
      level.points.push_back(point);
    }
  }
}

RealPoint ExactNurbs::de_boor(const Level& level, Real u) {
  const std::size_t p = level.degree, count = level.points.size();
  const auto above = std::upper_bound(level.knots.begin() + static_cast<std::ptrdiff_t>(p),
                                      level.knots.begin() + static_cast<std::ptrdiff_t>(count), u);
  const auto span = std::min(static_cast<std::size_t>(above - level.knots.begin()), count) - 1;
  std::vector<RealPoint> d(level.points.begin() + static_cast<std::ptrdiff_t>(span - p),
                           level.points.begin() + static_cast<std::ptrdiff_t>(span + 1));
  for (std::size_t r = 1; r <= p; ++r) {
    for (std::size_t j = p; j >= r; --j) {
      const Real low = level.knots[j + span - p], high = level.knots[j + 1 + span - r];
      const Real part = high > low ? (u - low) / (high - low) : 0;
      for (std::size_t c = 0; c < d[j].size(); ++c) d[j][c] = (1 - part) * d[j - 1][c] + part * d[j][c];
    }
  }
  return d[p];
}

std::vector<RealPoint> ExactNurbs::at(Real u, std::size_t order) const {
  std::vector<RealPoint> h, result;
  for (std::size_t k = 0; k <= order; ++k) h.push_back(de_boor(levels_[k], u));
  const Real w = h[0][dimension_];
  for (std::size_t k = 0; k <= order; ++k) {
    RealPoint point(dimension_);
    for (std::size_t c = 0; c < dimension_; ++c) {
      Real value = h[k][c];
      if (k >= 1) value -= static_cast<Real>(k) * h[1][dimension_] * result[k - 1][c];
      if (k == 2) value -= h[2][dimension_] * result[0][c];
      point[c] = value / w;
    }
    result.push_back(point);
  }
  return result;
}

Real ExactNurbs::speed(Real u) const {
  const auto d = at(u, 1);
  Real sum = 0;
  for (std::size_t c = 0; c < std::min<std::size_t>(3, dimension_); ++c) sum += d[1][c] * d[1][c];
  return std::sqrt(sum);
}

Real ExactNurbs::length_smooth(Real from, Real to) const {
  static constexpr Real kNode[5] = {0.1488743389816312108848260L, 0.4333953941292471907992659L,
                                    0.6794095682990244062343274L, 0.8650633666889845107320967L,
                                    0.9739065285171717200779640L};
  static constexpr Real kWeight[5] = {0.2955242247147528701738930L, 0.2692667193099963550912269L,
                                      0.2190863625159820439955349L, 0.1494513491505805931457763L,
                                      0.0666713443086881375935688L};
  const Real half = (to - from) / 2, middle = from + half;
  Real sum = 0;
  for (int i = 0; i < 5; ++i) sum += kWeight[i] * (speed(middle - half * kNode[i]) + speed(middle + half * kNode[i]));
  return sum * half;
}

Real ExactNurbs::length(Real from, Real to) const {
  Real sum = 0, at = from;
  const auto& knots = levels_[0].knots;
  while (at < to) {
    const auto next = std::upper_bound(knots.begin(), knots.end(), at);
    const Real until = next == knots.end() ? to : std::min(to, *next);
    sum += length_smooth(at, until);
    at = until;
  }
  return sum;
}

Real ExactNurbs::nearest(const double* point, Real guess) const {
  const Real found = newton(point, guess);
  if (distance(point, found) < 1e-9L) return found;
  // In a near-cusp Newton's method may leave for another branch: look around, then start anew.
  constexpr int kPlaces = 2000;
  const Real around = 0.02L * (end() - begin());
  Real best = found, least = distance(point, found);
  for (int i = -kPlaces; i <= kPlaces; ++i) {
    const Real u = std::clamp(guess + around * i / kPlaces, begin(), end());
    if (const Real here = distance(point, u); here < least) least = here, best = u;
  }
  const Real again = newton(point, best);
  return distance(point, again) < least ? again : best;
}

Real ExactNurbs::newton(const double* point, Real guess) const {
  Real u = std::clamp(guess, begin(), end());
  for (int i = 0; i < 40; ++i) {
    const auto d = at(u, 2);
    Real slope = 0, bend = 0;
    for (std::size_t c = 0; c < std::min<std::size_t>(3, dimension_); ++c) {
      const Real off = d[0][c] - point[c];
      slope += off * d[1][c];
      bend += d[1][c] * d[1][c] + off * d[2][c];
    }
    const Real next = std::clamp(u - slope / bend, begin(), end());
    if (std::abs(next - u) < 1e-17L * (1 + std::abs(u))) return next;
    u = next;
  }
  return u;
}

Real ExactNurbs::distance(const double* point, Real u) const {
  const auto d = at(u, 0);
  Real sum = 0;
  for (std::size_t c = 0; c < std::min<std::size_t>(3, dimension_); ++c)
    sum += (d[0][c] - point[c]) * (d[0][c] - point[c]);
  return std::sqrt(sum);
}

}  // namespace rmac::bench
