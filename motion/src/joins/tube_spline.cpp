#include "joins/tube_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "curves/vector.hpp"
#include "joins/banded.hpp"
#include "joins/quintic.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::cross;
using curves::difference;
using curves::dot;
using curves::scaled;
using curves::unit;
using quintic::Basis;
using quintic::kDegree;

constexpr int kSamplesASpan = 5;
/// How far along the path the spline may be from a vertex at its place, in widths: a vertex seen from too far aside is
/// seen from the wrong line.
constexpr double kVertexSlack = 5;
/// Control points that are given kept the tube of the fit before; its samples lay elsewhere.
constexpr double kGivenSlack = 1.01;
/// Gauss's points and weights of order 3 on [0, 1]: |S'''|² is a polynomial of degree 4.
constexpr std::array<double, 3> kGaussPoints{0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kGaussWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// -1 <= direction · (S - point) <= 1, and what the interior-point method keeps of it: where S is, and slack and
/// multiplier of the upper and the lower bound.
struct Bound {
  Vector direction{};
  double at = 0;
  std::array<double, 2> slack{}, multiplier{}, slack_step{}, multiplier_step{}, second_order{};
};

struct Sample {
  Basis basis;
  Vector point{};
  std::array<Bound, 4> bounds;
  std::size_t count = 0;

  [[nodiscard]] std::span<Bound> used() noexcept { return {bounds.data(), count}; }
  [[nodiscard]] std::span<const Bound> used() const noexcept { return {bounds.data(), count}; }
};

/// Lines' directions, and across each one the direction in which the polyline bends there and the third one.
struct LineFrame {
  Vector tangent, bend, side;
};

std::vector<LineFrame> frames_of(const Polyline& polyline) {
  const std::size_t lines = polyline.lines();
  std::vector<Vector> tangents;
  for (std::size_t k = 0; k < lines; ++k)
    tangents.push_back(unit(difference(polyline.vertices[k + 1], polyline.vertices[k])));
  std::vector<LineFrame> frames;
  for (std::size_t k = 0; k < lines; ++k) {
    const Vector& t = tangents[k];
    Vector bend = difference(tangents[std::min(k + 1, lines - 1)], tangents[k > 0 ? k - 1 : 0]);
    bend = along(bend, -dot(bend, t), t);
    if (dot(bend, bend) < 1e-12) {
      Vector least{};
      least[static_cast<std::size_t>(
          std::min_element(t.begin(), t.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
          t.begin())] = 1;
      bend = along(least, -dot(least, t), t);
    }
    bend = unit(bend);
    frames.push_back({t, bend, cross(t, bend)});
  }
  return frames;
}

class TubeProgram {
 public:
  TubeProgram(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths,
              std::size_t kept, std::vector<Vector>& points)
      : points_(points),
        kept_(kept),
        free_(points.size() - kept - 1),
        objective_(points.size(), kDegree),
        step_(3 * free_) {
    weigh_third_derivative(knots);
    lay_samples(knots, polyline, widths);
  }

  bool solve();

 private:
  static constexpr int kMostIterations = 60;
  static constexpr double kGap = 1e-3;       ///< of the objective: what is left to be gained
  static constexpr double kOutside = 1e-3;   ///< of the width
  static constexpr double kToBorder = 0.98;  ///< of the way to where a slack or multiplier would vanish

  void weigh_third_derivative(const std::vector<double>& knots);
  void lay_samples(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths);
  void across(const Basis& basis, const Vector& point, const LineFrame& frame, double width);
  void add(Sample sample);

  [[nodiscard]] bool is_free(std::size_t point) const noexcept { return point >= kept_ && point < kept_ + free_; }
  /// Σ (weights of the bounds) direction directionᵀ, added to the objective.
  template <class Weight>
  [[nodiscard]] bool factorise(Banded& matrix, const Weight& weight) const;
  /// Adds the samples' directions times a factor to the right side.
  template <class Factor>
  void gather(const Factor& factor, std::vector<double>& right) const;
  /// Minus the objective's gradient; returns the objective.
  double objective(std::vector<double>& right) const;
  [[nodiscard]] Vector step_of(const Basis& basis) const;
  void measure();
  void go(double reach);
  bool start();
  /// Solves for `step_` and the steps of slacks and multipliers, aiming at this product of both; returns how far to go.
  double direction(const Banded& matrix, const std::vector<double>& gradient, double product);

  std::vector<Vector>& points_;
  std::size_t kept_;
  std::size_t free_;
  Banded objective_;
  std::vector<Sample> samples_;
  std::size_t bound_count_ = 0;
  std::vector<double> step_;
};

void TubeProgram::weigh_third_derivative(const std::vector<double>& knots) {
  for (std::size_t i = kDegree; i < points_.size(); ++i) {
    const double width = knots[i + 1] - knots[i];
    for (std::size_t g = 0; g < kGaussPoints.size(); ++g) {
      const Basis third = quintic::third_derivatives(knots, points_.size(), knots[i] + width * kGaussPoints[g]);
      for (std::size_t a = 0; a <= kDegree; ++a) {
        for (std::size_t b = 0; b <= a; ++b)
          objective_.at(third.first + a, a - b) += width * kGaussWeights[g] * third.values[a] * third.values[b];
      }
    }
  }
}

void TubeProgram::add(Sample sample) {
  if (!is_free(sample.basis.first) && !is_free(sample.basis.first + kDegree)) return;
  bound_count_ += 2 * sample.count;
  samples_.push_back(sample);
}

/// An octagon about the line.
void TubeProgram::across(const Basis& basis, const Vector& point, const LineFrame& frame, double width) {
  const double given = basis.first < kept_ ? kGivenSlack : 1;
  const double scale = 1 / (width * given), diagonal = scale * std::sqrt(0.5);
  Sample sample{basis, point, {}, 4};
  sample.bounds[0].direction = scaled(scale, frame.bend);
  sample.bounds[1].direction = scaled(scale, frame.side);
  sample.bounds[2].direction = along(scaled(diagonal, frame.bend), diagonal, frame.side);
  sample.bounds[3].direction = along(scaled(diagonal, frame.bend), -diagonal, frame.side);
  add(sample);
}

void TubeProgram::lay_samples(const std::vector<double>& knots, const Polyline& polyline,
                              const std::vector<double>& widths) {
  const auto frames = frames_of(polyline);
  const std::size_t count = points_.size(), lines = polyline.lines();
  std::size_t line = 0;
  for (std::size_t i = kDegree; i < count; ++i) {
    for (int part = 0; part < kSamplesASpan; ++part) {
      const double place = knots[i] + (knots[i + 1] - knots[i]) * part / kSamplesASpan;
      while (line + 1 < lines && polyline.places[line + 1] <= place) ++line;
      across(quintic::basis(knots, count, place), polyline.vertices[line], frames[line], widths[line]);
    }
  }
  for (std::size_t k = 1; k < lines; ++k) {
    if (polyline.places[k] <= knots[kDegree]) continue;
    const Basis basis = quintic::basis(knots, count, polyline.places[k]);
    const Vector& vertex = polyline.vertices[k];
    for (const std::size_t side : {k - 1, k}) across(basis, vertex, frames[side], widths[side]);
    const double shorter =
        std::min(polyline.places[k] - polyline.places[k - 1], polyline.places[k + 1] - polyline.places[k]);
    const double slack = std::min(kVertexSlack * widths[k], 0.2 * shorter);
    Sample sample{basis, vertex, {}, 1};
    sample.bounds[0].direction = scaled(1 / slack, unit(along(frames[k - 1].tangent, 1, frames[k].tangent)));
    add(sample);
  }
}

template <class Weight>
bool TubeProgram::factorise(Banded& matrix, const Weight& weight) const {
  for (std::size_t i = 0; i < free_; ++i) {
    for (std::size_t k = 0; k <= kDegree && k <= i; ++k) {
      for (std::size_t c = 0; c < 3; ++c) matrix.at(3 * i + c, 3 * k) += objective_.at(kept_ + i, k);
    }
  }
  for (const Sample& sample : samples_) {
    std::array<Vector, 3> square{};
    for (const Bound& bound : sample.used()) {
      const double w = weight(bound);
      for (std::size_t c = 0; c < 3; ++c) square[c] = along(square[c], w * bound.direction[c], bound.direction);
    }
    for (std::size_t a = 0; a <= kDegree; ++a) {
      if (!is_free(sample.basis.first + a)) continue;
      const std::size_t row = 3 * (sample.basis.first + a - kept_);
      for (std::size_t b = 0; b <= a; ++b) {
        if (!is_free(sample.basis.first + b)) continue;
        const double factor = sample.basis.values[a] * sample.basis.values[b];
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t most = a == b ? c : 2;
          for (std::size_t e = 0; e <= most; ++e) matrix.at(row + c, 3 * (a - b) + c - e) += factor * square[c][e];
        }
      }
    }
  }
  return matrix.factorise();
}

template <class Factor>
void TubeProgram::gather(const Factor& factor, std::vector<double>& right) const {
  for (const Sample& sample : samples_) {
    Vector sum{};
    for (const Bound& bound : sample.used()) sum = along(sum, factor(bound), bound.direction);
    for (std::size_t a = 0; a <= kDegree; ++a) {
      if (!is_free(sample.basis.first + a)) continue;
      const std::size_t row = 3 * (sample.basis.first + a - kept_);
      for (std::size_t c = 0; c < 3; ++c) right[row + c] += sample.basis.values[a] * sum[c];
    }
  }
}

double TubeProgram::objective(std::vector<double>& right) const {
  // About the first control point, for the third derivative does not see where the part stands.
  const Vector& origin = points_.front();
  double value = 0;
  std::fill(right.begin(), right.end(), 0.0);
  std::vector<Vector> gradient(points_.size(), Vector{});
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t k = 0; k <= kDegree && k <= i; ++k) {
      const double entry = objective_.at(i, k);
      gradient[i] = along(gradient[i], entry, difference(points_[i - k], origin));
      if (k > 0) gradient[i - k] = along(gradient[i - k], entry, difference(points_[i], origin));
    }
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    value += 0.5 * dot(gradient[i], difference(points_[i], origin));
    if (!is_free(i)) continue;
    for (std::size_t c = 0; c < 3; ++c) right[3 * (i - kept_) + c] = -gradient[i][c];
  }
  return value;
}

Vector TubeProgram::step_of(const Basis& basis) const {
  Vector sum{};
  for (std::size_t a = 0; a <= kDegree; ++a) {
    if (!is_free(basis.first + a)) continue;
    const std::size_t at = 3 * (basis.first + a - kept_);
    sum = along(sum, basis.values[a], {step_[at], step_[at + 1], step_[at + 2]});
  }
  return sum;
}

void TubeProgram::measure() {
  for (Sample& sample : samples_) {
    const Vector off = difference(quintic::value(sample.basis, points_), sample.point);
    for (Bound& bound : sample.used()) bound.at = dot(bound.direction, off);
  }
}

void TubeProgram::go(double reach) {
  for (std::size_t i = 0; i < free_; ++i)
    points_[kept_ + i] = along(points_[kept_ + i], reach, {step_[3 * i], step_[3 * i + 1], step_[3 * i + 2]});
  measure();
}

/// A weighted fit, and slacks and multipliers that suit it.
bool TubeProgram::start() {
  for (std::size_t i = kept_; i < kept_ + free_; ++i) points_[i] = points_.front();
  measure();
  Banded matrix(3 * free_, 3 * kDegree + 2);
  if (!factorise(matrix, [](const Bound&) { return 1.0; })) return false;
  objective(step_);
  gather([](const Bound& bound) { return -bound.at; }, step_);
  matrix.substitute(step_);
  go(1);
  const double product = std::max(objective(step_), 1e-12) / static_cast<double>(bound_count_);
  for (Sample& sample : samples_) {
    for (Bound& bound : sample.used()) {
      bound.slack = {std::max(1 - bound.at, 0.1), std::max(1 + bound.at, 0.1)};
      bound.multiplier = {product / bound.slack[0], product / bound.slack[1]};
    }
  }
  return true;
}

double TubeProgram::direction(const Banded& matrix, const std::vector<double>& gradient, double product) {
  const auto outside = [](const Bound& bound, std::size_t i) {
    return (i == 0 ? bound.at : -bound.at) + bound.slack[i] - 1;
  };
  const auto excess = [product](const Bound& bound, std::size_t i) {
    return bound.slack[i] * bound.multiplier[i] + bound.second_order[i] - product;
  };
  step_ = gradient;
  gather(
      [&](const Bound& bound) {
        std::array<double, 2> pull{};
        for (std::size_t i = 0; i < 2; ++i) {
          pull[i] = bound.multiplier[i] + (bound.multiplier[i] * outside(bound, i) - excess(bound, i)) / bound.slack[i];
        }
        return pull[1] - pull[0];
      },
      step_);
  matrix.substitute(step_);

  double reach = 1;
  const auto keep_positive = [&reach](double value, double step) {
    if (step < 0) reach = std::min(reach, -kToBorder * value / step);
  };
  for (Sample& sample : samples_) {
    const Vector step = step_of(sample.basis);
    for (Bound& bound : sample.used()) {
      const double move = dot(bound.direction, step);
      for (std::size_t i = 0; i < 2; ++i) {
        bound.slack_step[i] = -outside(bound, i) - (i == 0 ? move : -move);
        bound.multiplier_step[i] = -(excess(bound, i) + bound.multiplier[i] * bound.slack_step[i]) / bound.slack[i];
        keep_positive(bound.slack[i], bound.slack_step[i]);
        keep_positive(bound.multiplier[i], bound.multiplier_step[i]);
      }
    }
  }
  return reach;
}

/// Mehrotra's predictor and corrector (eq. 13).
bool TubeProgram::solve() {
  if (!start()) return false;
  std::vector<double> gradient(3 * free_);
  const auto count = static_cast<double>(bound_count_);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const double value = objective(gradient);
    double product = 0, off = 0;
    for (Sample& sample : samples_) {
      for (Bound& bound : sample.used()) {
        off = std::max(off, std::abs(bound.at) - 1);
        bound.second_order = {};
        for (std::size_t i = 0; i < 2; ++i) product += bound.slack[i] * bound.multiplier[i];
      }
    }
    if (!std::isfinite(product)) return false;
    if (product <= kGap * value && off <= kOutside) return true;

    Banded matrix(3 * free_, 3 * kDegree + 2);
    const auto stiffness = [](const Bound& bound) {
      return bound.multiplier[0] / bound.slack[0] + bound.multiplier[1] / bound.slack[1];
    };
    if (!factorise(matrix, stiffness)) return false;
    double reach = direction(matrix, gradient, 0);
    double predicted = 0;
    for (Sample& sample : samples_) {
      for (Bound& bound : sample.used()) {
        for (std::size_t i = 0; i < 2; ++i) {
          predicted +=
              (bound.slack[i] + reach * bound.slack_step[i]) * (bound.multiplier[i] + reach * bound.multiplier_step[i]);
          bound.second_order[i] = bound.slack_step[i] * bound.multiplier_step[i];
        }
      }
    }
    reach = direction(matrix, gradient, std::pow(predicted / product, 3) * product / count);
    for (Sample& sample : samples_) {
      for (Bound& bound : sample.used()) {
        for (std::size_t i = 0; i < 2; ++i) {
          bound.slack[i] += reach * bound.slack_step[i];
          bound.multiplier[i] += reach * bound.multiplier_step[i];
        }
      }
    }
    go(reach);
  }
  return false;
}

}  // namespace

bool smoothest_in_tube(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths_mm,
                       std::size_t kept, std::vector<Vector>& points) {
  points.resize(knots.size() - kDegree - 1);
  if (points.size() < kept + 2) return false;
  if (kept == 1) points.front() = polyline.vertices.front();
  points.back() = polyline.vertices.back();
  return TubeProgram(knots, polyline, widths_mm, kept, points).solve();
}

}  // namespace rmac
