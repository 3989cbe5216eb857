#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace rmac::modules {

/// Control surface of a fuzzy law with 25 rules (Takagi and Sugeno's inference of order zero). Error and rate, each
/// scaled to -1..1, belong to the terms NB, NS, Z, PS, PB (negative big to positive big) by triangles that peak at
/// `kPeaks` and end where the neighbours peak, so the memberships of a value sum up to 1. A rule's weight is the
/// product of its two memberships, its consequence one of `kLevels`; the output is the weighted mean. Between peaks
/// that is bilinear; beyond the outer peaks it stays.
class FuzzySurface {
 public:
  static constexpr std::size_t kTerms = 5;
  static constexpr std::array<double, kTerms> kPeaks{-1, -0.25, 0, 0.25, 1};
  static constexpr std::array<double, kTerms> kLevels{-1, -0.5, 0, 0.5, 1};
  /// Indices into `kLevels`; rows by the error's term, columns by the rate's, NB first.
  static constexpr std::array<std::array<std::size_t, kTerms>, kTerms> kRules{
      {{0, 0, 0, 1, 2}, {0, 0, 1, 2, 3}, {0, 1, 2, 3, 4}, {1, 2, 3, 4, 4}, {2, 3, 4, 4, 4}}};
  /// Slope of the surface at its centre, towards either input: its steepest.
  static constexpr double kCentreSlope = 2;

  [[nodiscard]] static double at(double error, double rate) noexcept {
    const Place e = place(error);
    const Place r = place(rate);
    const auto level = [](std::size_t i, std::size_t j) { return kLevels[kRules[i][j]]; };
    const double low = level(e.term, r.term) * (1 - r.part) + level(e.term, r.term + 1) * r.part;
    const double high = level(e.term + 1, r.term) * (1 - r.part) + level(e.term + 1, r.term + 1) * r.part;
    return low * (1 - e.part) + high * e.part;
  }

 private:
  struct Place {
    std::size_t term;  ///< the lower of the two terms that it belongs to
    double part;       ///< its membership of the upper one
  };
  [[nodiscard]] static Place place(double value) noexcept {
    const double inside = std::clamp(value, kPeaks.front(), kPeaks.back());
    std::size_t term = 0;
    while (term + 2 < kTerms && inside > kPeaks[term + 1]) ++term;
    return {term, (inside - kPeaks[term]) / (kPeaks[term + 1] - kPeaks[term])};
  }
};

}  // namespace rmac::modules
