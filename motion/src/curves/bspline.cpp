#include "bspline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::curves {

BSpline::BSpline(const Nurbs& nurbs)
    : degree_(static_cast<std::size_t>(nurbs.degree)),
      dimension_(nurbs.dimension),
      width_(nurbs.dimension + (nurbs.weights.empty() ? 0U : 1U)),
      rational_(!nurbs.weights.empty()) {
  const std::size_t count = nurbs.points.size();
  first_ = nurbs.knots[degree_];
  range_ = nurbs.knots[count] - first_;
  knots_.reserve(nurbs.knots.size());
  for (const double knot : nurbs.knots) knots_.push_back((knot - first_) / range_);
  for (std::size_t i = degree_; i < count; ++i) {
    if (knots_[i + 1] > knots_[i]) spans_.push_back(i);
  }

  for (std::size_t c = 0; c < dimension_; ++c) origin_[c] = nurbs.points[0][c];
  points_.emplace_back();
  points_[0].reserve(count * width_);
  for (std::size_t i = 0; i < count; ++i) {
    const double weight = rational_ ? nurbs.weights[i] : 1;
    for (std::size_t c = 0; c < dimension_; ++c) points_[0].push_back(weight * (nurbs.points[i][c] - origin_[c]));
    if (rational_) points_[0].push_back(weight);
  }
  make_derivatives();
  if (degree_ <= kPowerDegree) make_powers();
}

/// The NURBS Book, eq. 3.8; a derivative's point whose support is empty is never used.
void BSpline::make_derivatives() {
  const std::size_t most = degree_ <= kPowerDegree ? degree_ : 3;
  for (std::size_t k = 1; k <= most; ++k) {
    const std::vector<double>& before = points_.back();
    const std::size_t left = before.size() / width_ - 1;
    std::vector<double> points(left * width_);
    for (std::size_t i = 0; i < left; ++i) {
      const double support = knots_[i + degree_ + 1] - knots_[i + k];
      const double factor = support > 0 ? static_cast<double>(degree_ - k + 1) / support : 0;
      for (std::size_t c = 0; c < width_; ++c)
        points[i * width_ + c] = factor * (before[(i + 1) * width_ + c] - before[i * width_ + c]);
    }
    points_.push_back(std::move(points));
  }
}

/// Taylor's series about the middle of each span, in u = 2 t / width - 1 (docs/derivations/curves.md, section 3).
void BSpline::make_powers() {
  const std::size_t row = (width_ + kLanes - 1) / kLanes * kLanes;
  powers_.assign(spans_.size() * (degree_ + 1) * row, 0.0);
  power_rates_.reserve(spans_.size());
  std::array<Homogeneous, kPowerDegree + 1> derivatives;
  double* out = powers_.data();
  for (std::size_t span = 0; span < spans_.size(); ++span) {
    const double half = span_width(span) / 2;
    power_rates_.push_back(1 / half);
    basis_sums(span, half, {derivatives.data(), degree_ + 1});
    double factor = 1;
    for (std::size_t k = 0; k <= degree_; ++k, out += row, factor *= half / static_cast<double>(k)) {
      for (std::size_t c = 0; c < width_; ++c) out[c] = factor * derivatives[k][c];
    }
  }
  points_.resize(1);
}

std::size_t BSpline::multiplicity(std::size_t span) const noexcept {
  const auto [low, high] = std::equal_range(knots_.begin(), knots_.end(), knots_[spans_[span]]);
  return static_cast<std::size_t>(high - low);
}

double BSpline::extent(std::size_t first, std::size_t last) const noexcept {
  double most = 0;
  for (std::size_t i = 0; i < points_[0].size(); i += width_) {
    const double weight = rational_ ? points_[0][i + dimension_] : 1;
    double sum = 0;
    for (std::size_t c = first; c < last; ++c) sum += points_[0][i + c] * points_[0][i + c] / (weight * weight);
    most = std::max(most, std::sqrt(sum));
  }
  return most;
}

std::vector<double> BSpline::control_point(std::size_t span, std::size_t i, std::size_t first, std::size_t last) const {
  const double* const stored = points_[0].data() + (spans_[span] - degree_ + i) * width_;
  const double weight = rational_ ? stored[dimension_] : 1;
  std::vector<double> point;
  for (std::size_t c = first; c < last; ++c) point.push_back(stored[c] / weight + origin_[c]);
  return point;
}

void BSpline::basis_sums(std::size_t span, double t, std::span<Homogeneous> sums) const noexcept {
  const std::size_t knot = spans_[span];
  const double* const after = knots_.data() + knot;
  std::array<double, kMaxDegree + 1> basis;
  std::array<double, kMaxDegree + 1> left;
  std::array<double, kMaxDegree + 1> right;
  basis[0] = 1;
  for (std::size_t j = 0;; ++j) {
    // The functions of degree j carry the derivative of order degree - j (docs/derivations/curves.md, eq. 5).
    const std::size_t k = degree_ - j;
    if (k < sums.size()) {
      const double* points = points_[k].data() + (knot - degree_) * width_;
      Homogeneous& sum = sums[k];
      for (std::size_t c = 0; c < width_; ++c) sum[c] = basis[0] * points[c];
      for (std::size_t l = 1; l <= j; ++l) {
        points += width_;
        for (std::size_t c = 0; c < width_; ++c) sum[c] += basis[l] * points[c];
      }
    }
    if (j == degree_) return;
    // A2.2 of The NURBS Book, from degree j to j + 1.
    left[j + 1] = t + (after[0] - *(after - j));
    right[j + 1] = (after[j + 1] - after[0]) - t;
    double saved = 0;
    for (std::size_t r = 0; r <= j; ++r) {
      const double share = basis[r] / (right[r + 1] + left[j + 1 - r]);
      basis[r] = saved + right[r + 1] * share;
      saved = left[j + 1 - r] * share;
    }
    basis[j + 1] = saved;
  }
}

template <std::size_t kOrder, typename Row>
void BSpline::power_sums(std::size_t span, double t, std::array<Row, 4>& sums) const noexcept {
  static constexpr std::array<double, 4> kFactorial{1, 1, 2, 6};
  const std::size_t row = (width_ + kLanes - 1) / kLanes * kLanes;
  const double* const coefficients = powers_.data() + span * (degree_ + 1) * row;
  const double rate = power_rates_[span];
  const double u = rate * t - 1;
  for (std::size_t c = 0; c < row; c += kLanes) {
    // Horner's scheme; the rows above the first carry the derivatives, divided by their factorials.
    std::array<Lanes, kOrder + 1> d{load(coefficients + degree_ * row + c)};
    for (std::size_t i = degree_; i-- > 0;) {
      const Lanes next = load(coefficients + i * row + c);
      for (std::size_t k = kOrder; k > 0; --k) d[k] = d[k] * u + d[k - 1];
      d[0] = d[0] * u + next;
    }
    double factor = 1;
    for (std::size_t k = 0; k <= kOrder; ++k, factor *= rate) {
      store(d[k] * (kFactorial[k] * factor), sums[k].data() + c);
    }
  }
}

void BSpline::evaluate(std::size_t span, double t, int order, CurvePoint& point) const noexcept {
  static constexpr double kBinomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  const auto wanted = static_cast<std::size_t>(std::clamp(order, 0, 3));
  const auto add_powers = [&](auto& rows) { wanted > 1 ? power_sums<3>(span, t, rows) : power_sums<1>(span, t, rows); };
  std::array<Homogeneous, 4> sums;
  if (!powers_.empty() && !rational_) {
    static_assert(kMaxJoints % kLanes == 0, "a point has room for whole lanes");
    add_powers(point.d);
  } else if (!powers_.empty()) {
    add_powers(sums);
  } else {
    basis_sums(span, t, {sums.data(), wanted + 1});
  }
  if (!rational_ && powers_.empty()) {
    for (std::size_t k = 0; k <= wanted; ++k) std::copy_n(sums[k].begin(), dimension_, point.d[k].begin());
  }
  if (rational_) {
    const double inverse_weight = 1 / sums[0][dimension_];
    for (std::size_t k = 0; k <= wanted; ++k) {
      for (std::size_t c = 0; c < dimension_; ++c) {
        double value = sums[k][c];
        for (std::size_t i = 1; i <= k; ++i) value -= kBinomial[k][i] * sums[i][dimension_] * point.d[k - i][c];
        point.d[k][c] = value * inverse_weight;
      }
    }
  }
  for (std::size_t c = 0; c < dimension_; ++c) point.d[0][c] += origin_[c];
}

void BSpline::differentiate(std::size_t span, double t, CurvePoint& point) const noexcept {
  if (powers_.empty() || rational_) {
    evaluate(span, t, 1, point);
    return;
  }
  const std::size_t row = (width_ + kLanes - 1) / kLanes * kLanes;
  const double* const coefficients = powers_.data() + span * (degree_ + 1) * row;
  const double rate = power_rates_[span];
  const double u = rate * t - 1;
  for (std::size_t c = 0; c < row; c += kLanes) {
    Lanes d{};
    double power = static_cast<double>(degree_);
    for (std::size_t i = degree_; i > 0; --i, --power) d = d * u + power * load(coefficients + i * row + c);
    store(d * rate, point.d[1].data() + c);
  }
}

}  // namespace rmac::curves
