#include "tubes/tube_program.hpp"

#include <algorithm>
#include <cmath>

#include "curves/vector.hpp"

namespace rmac {

using curves::along;
using curves::difference;
using curves::dot;
using quintic::Basis;
using quintic::kDegree;

TubeProgram::TubeProgram(std::size_t kept, std::vector<Vector>& points)
    : points_(points),
      kept_(kept),
      free_(points.size() - kept - 1),
      objective_(3 * free_, 3 * kDegree + 2),
      step_(3 * free_) {}

void TubeProgram::add(const TubeSample& sample) {
  if (!is_free(sample.basis.first) && !is_free(sample.basis.first + kDegree)) return;
  bound_count_ += 2 * sample.count;
  samples_.push_back(sample);
}

void TubeProgram::weigh(const Basis& basis, const std::array<Vector, 3>& square, Banded& matrix) const {
  const auto [xx, xy, xz] = square[0];
  const double yy = square[1][1], yz = square[1][2], zz = square[2][2];
  for (std::size_t a = 0; a <= kDegree; ++a) {
    if (!is_free(basis.first + a)) continue;
    const std::size_t row = 3 * (basis.first + a - kept_);
    for (std::size_t b = 0; b < a; ++b) {
      if (!is_free(basis.first + b)) continue;
      const double f = basis.values[a] * basis.values[b];
      // Rows of the block, whose columns stand in memory from the last to the first.
      double *const x = &matrix.at(row, 3 * (a - b) - 2), *const y = &matrix.at(row + 1, 3 * (a - b) - 1);
      double* const z = &matrix.at(row + 2, 3 * (a - b));
      x[0] += f * xz, x[1] += f * xy, x[2] += f * xx;
      y[0] += f * yz, y[1] += f * yy, y[2] += f * xy;
      z[0] += f * zz, z[1] += f * yz, z[2] += f * xz;
    }
    const double f = basis.values[a] * basis.values[a];
    double *const x = &matrix.at(row, 0), *const y = &matrix.at(row + 1, 0), *const z = &matrix.at(row + 2, 0);
    x[0] += f * xx;
    y[0] += f * yy, y[1] += f * xy;
    z[0] += f * zz, z[1] += f * yz, z[2] += f * xz;
  }
}

void TubeProgram::pull(const Basis& basis, const Vector& sum, std::vector<double>& right) const {
  for (std::size_t a = 0; a <= kDegree; ++a) {
    if (!is_free(basis.first + a)) continue;
    const std::size_t row = 3 * (basis.first + a - kept_);
    for (std::size_t c = 0; c < 3; ++c) right[row + c] += basis.values[a] * sum[c];
  }
}

template <class Weight>
bool TubeProgram::factorise(Banded& matrix, const Weight& weight) const {
  matrix = objective_;
  for (const TubeSample& sample : samples_) {
    std::array<Vector, 3> square{};
    for (const TubeBound& bound : sample.used()) {
      const double w = weight(bound);
      for (std::size_t c = 0; c < 3; ++c) square[c] = along(square[c], w * bound.direction[c], bound.direction);
    }
    weigh(sample.basis, square, matrix);
  }
  return matrix.factorise();
}

template <class Factor>
void TubeProgram::gather(const Factor& factor, std::vector<double>& right) const {
  for (const TubeSample& sample : samples_) {
    Vector sum{};
    for (const TubeBound& bound : sample.used()) sum = along(sum, factor(bound), bound.direction);
    pull(sample.basis, sum, right);
  }
}

double TubeProgram::objective(const std::vector<SplineDemand>& demands, std::vector<double>& right) const {
  // About the first control point, for no derivative sees where the part stands.
  const Vector& origin = points_.front();
  double value = 0;
  std::fill(right.begin(), right.end(), 0.0);
  for (const SplineDemand& demand : demands) {
    Vector x{};
    for (std::size_t a = 0; a <= kDegree; ++a)
      x = along(x, demand.basis.values[a], difference(points_[demand.basis.first + a], origin));
    const Vector bent{dot(demand.weight[0], x), dot(demand.weight[1], x), dot(demand.weight[2], x)};
    value += 0.5 * dot(bent, x) - dot(demand.pull, x) + demand.constant;
    pull(demand.basis, difference(demand.pull, bent), right);
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
  for (TubeSample& sample : samples_) {
    const Vector off = difference(quintic::value(sample.basis, points_), sample.point);
    for (TubeBound& bound : sample.used()) bound.at = dot(bound.direction, off);
  }
}

void TubeProgram::go(double reach) {
  for (std::size_t i = 0; i < free_; ++i)
    points_[kept_ + i] = along(points_[kept_ + i], reach, {step_[3 * i], step_[3 * i + 1], step_[3 * i + 2]});
  measure();
}

/// Slacks and multipliers that suit the points, which unless given are those of a weighted fit.
bool TubeProgram::start(const std::vector<SplineDemand>& demands, bool from_here) {
  if (!from_here) {
    for (std::size_t i = kept_; i < kept_ + free_; ++i) points_[i] = points_.front();
    measure();
    Banded matrix = objective_;
    if (!factorise(matrix, [](const TubeBound&) { return 1.0; })) return false;
    objective(demands, step_);
    gather([](const TubeBound& bound) { return -bound.at; }, step_);
    matrix.substitute(step_);
    go(1);
  } else {
    measure();
  }
  const double product = std::max(objective(demands, step_), 1e-12) / static_cast<double>(bound_count_);
  for (TubeSample& sample : samples_) {
    for (TubeBound& bound : sample.used()) {
      bound.slack = {std::max(1 - bound.at, 0.1), std::max(1 + bound.at, 0.1)};
      bound.multiplier = {product / bound.slack[0], product / bound.slack[1]};
    }
  }
  return true;
}

double TubeProgram::direction(const Banded& matrix, const std::vector<double>& gradient, double product) {
  const auto outside = [](const TubeBound& bound, std::size_t i) {
    return (i == 0 ? bound.at : -bound.at) + bound.slack[i] - 1;
  };
  const auto excess = [product](const TubeBound& bound, std::size_t i) {
    return bound.slack[i] * bound.multiplier[i] + bound.second_order[i] - product;
  };
  step_ = gradient;
  gather(
      [&](const TubeBound& bound) {
        std::array<double, 2> pull{};
        for (std::size_t i = 0; i < 2; ++i) {
          pull[i] = bound.multiplier[i] +
                    (bound.multiplier[i] * outside(bound, i) - excess(bound, i)) * bound.inverse_slack[i];
        }
        return pull[1] - pull[0];
      },
      step_);
  matrix.substitute(step_);

  double reach = 1;
  const auto keep_positive = [&reach](double value, double step) {
    if (-step * reach > kToBorder * value) reach = -kToBorder * value / step;
  };
  for (TubeSample& sample : samples_) {
    const Vector step = step_of(sample.basis);
    for (TubeBound& bound : sample.used()) {
      const double move = dot(bound.direction, step);
      for (std::size_t i = 0; i < 2; ++i) {
        bound.slack_step[i] = -outside(bound, i) - (i == 0 ? move : -move);
        bound.multiplier_step[i] =
            -(excess(bound, i) + bound.multiplier[i] * bound.slack_step[i]) * bound.inverse_slack[i];
        keep_positive(bound.slack[i], bound.slack_step[i]);
        keep_positive(bound.multiplier[i], bound.multiplier_step[i]);
      }
    }
  }
  return reach;
}

/// Mehrotra's predictor and corrector (eq. 13).
bool TubeProgram::solve(const std::vector<SplineDemand>& demands, bool from_here, std::size_t& work) {
  objective_ = Banded(3 * free_, 3 * kDegree + 2);
  for (const SplineDemand& demand : demands) weigh(demand.basis, demand.weight, objective_);
  if (!start(demands, from_here)) return false;
  std::vector<double> gradient(3 * free_);
  Banded matrix = objective_;
  const auto count = static_cast<double>(bound_count_);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    work += samples_.size();
    const double value = objective(demands, gradient);
    double product = 0, off = 0;
    for (TubeSample& sample : samples_) {
      for (TubeBound& bound : sample.used()) {
        off = std::max(off, std::abs(bound.at) - 1);
        bound.second_order = {};
        for (std::size_t i = 0; i < 2; ++i) {
          product += bound.slack[i] * bound.multiplier[i];
          bound.inverse_slack[i] = 1 / bound.slack[i];
        }
      }
    }
    if (!std::isfinite(product)) return false;
    if (product <= kGap * value && off <= kOutside) return true;

    const auto stiffness = [](const TubeBound& bound) {
      return bound.multiplier[0] * bound.inverse_slack[0] + bound.multiplier[1] * bound.inverse_slack[1];
    };
    if (!factorise(matrix, stiffness)) return false;
    double reach = direction(matrix, gradient, 0);
    double predicted = 0;
    for (TubeSample& sample : samples_) {
      for (TubeBound& bound : sample.used()) {
        for (std::size_t i = 0; i < 2; ++i) {
          predicted +=
              (bound.slack[i] + reach * bound.slack_step[i]) * (bound.multiplier[i] + reach * bound.multiplier_step[i]);
          bound.second_order[i] = bound.slack_step[i] * bound.multiplier_step[i];
        }
      }
    }
    reach = direction(matrix, gradient, std::pow(predicted / product, 3) * product / count);
    for (TubeSample& sample : samples_) {
      for (TubeBound& bound : sample.used()) {
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

}  // namespace rmac
