#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "splines/banded.hpp"
#include "splines/quintic.hpp"

namespace rmac {

/// A part of what is to be made small: ½ x·W x - pull·x + constant, with x = Σ basis · control points, some derivative
/// of the spline at some place.
struct SplineDemand {
  quintic::Basis basis;
  std::array<Vector, 3> weight{};  ///< W, symmetric
  Vector pull{};
  double constant = 0;
};

/// -1 <= direction · (S - point) <= 1, and what the interior-point method keeps of it: where S is, and slack and
/// multiplier of the upper and the lower bound.
struct TubeBound {
  Vector direction{};
  double at = 0;
  std::array<double, 2> slack{}, inverse_slack{}, multiplier{}, slack_step{}, multiplier_step{}, second_order{};
};

/// A place of the spline, and what bounds it there.
struct TubeSample {
  quintic::Basis basis;
  Vector point{};
  std::array<TubeBound, 4> bounds;
  std::size_t count = 0;

  [[nodiscard]] std::span<TubeBound> used() noexcept { return {bounds.data(), count}; }
  [[nodiscard]] std::span<const TubeBound> used() const noexcept { return {bounds.data(), count}; }
};

/// The quadratic program for a spline in a tube (docs/derivations/joins.md, section 7), solved by an interior-point
/// method. The first `kept` control points, and the last, stay as they are.
class TubeProgram {
 public:
  TubeProgram(std::size_t kept, std::vector<Vector>& points);

  void add(const TubeSample& sample);
  /// Whether the control points were found; otherwise they are left anywhere. `from_here`: they are in the tube, and
  /// not far from what is looked for. `work` grows by what it took: samples gone through.
  [[nodiscard]] bool solve(const std::vector<SplineDemand>& demands, bool from_here, std::size_t& work);

 private:
  static constexpr int kMostIterations = 60;
  static constexpr double kGap = 1e-3;       ///< of the objective: what is left to be gained
  static constexpr double kOutside = 1e-3;   ///< of the width
  static constexpr double kToBorder = 0.98;  ///< of the way to where a slack or multiplier would vanish

  [[nodiscard]] bool is_free(std::size_t point) const noexcept { return point >= kept_ && point < kept_ + free_; }
  void weigh(const quintic::Basis& basis, const std::array<Vector, 3>& square, Banded& matrix) const;
  void pull(const quintic::Basis& basis, const Vector& sum, std::vector<double>& right) const;
  /// The objective's matrix and Σ (weights of the bounds) direction directionᵀ.
  template <class Weight>
  [[nodiscard]] bool factorise(Banded& matrix, const Weight& weight) const;
  /// Adds the samples' directions times a factor to the right side.
  template <class Factor>
  void gather(const Factor& factor, std::vector<double>& right) const;
  /// Minus the objective's gradient; returns the objective.
  double objective(const std::vector<SplineDemand>& demands, std::vector<double>& right) const;
  [[nodiscard]] Vector step_of(const quintic::Basis& basis) const;
  void measure();
  void go(double reach);
  bool start(const std::vector<SplineDemand>& demands, bool from_here);
  /// Solves for `step_` and the steps of slacks and multipliers, aiming at this product of both; returns how far to go.
  double direction(const Banded& matrix, const std::vector<double>& gradient, double product);

  std::vector<Vector>& points_;
  std::size_t kept_;
  std::size_t free_;
  Banded objective_;
  std::vector<TubeSample> samples_;
  std::size_t bound_count_ = 0;
  std::vector<double> step_;
};

}  // namespace rmac
