#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace rmac::curves {

/// Interpolation of degree N on [-1, 1] at the Lobatto points x_j = cos(pi j / N), which include both ends.
template <std::size_t N>
class Chebyshev {
 public:
  using Values = std::array<double, N + 1>;

  Chebyshev() noexcept {
    for (std::size_t j = 0; j <= N; ++j) {
      for (std::size_t k = 0; k <= N; ++k) {
        cosine_[j][k] = std::cos(std::numbers::pi * static_cast<double>(j * k % (2 * N)) / static_cast<double>(N));
      }
    }
  }

  [[nodiscard]] double node(std::size_t j) const noexcept { return cosine_[j][1]; }

  /// Coefficients of the polynomial through `values` at the nodes.
  [[nodiscard]] Values coefficients(const Values& values) const noexcept {
    // Row by row, which the compiler can do for several coefficients at once.
    Values result{};
    for (std::size_t j = 0; j <= N; ++j) {
      const double value = (j == 0 || j == N ? 1.0 : 2.0) / static_cast<double>(N) * values[j];
      for (std::size_t k = 0; k <= N; ++k) result[k] += value * cosine_[j][k];
    }
    result.front() /= 2;
    result.back() /= 2;
    return result;
  }

 private:
  std::array<Values, N + 1> cosine_{};
};

/// Clenshaw's sum of Chebyshev coefficients at x.
template <std::size_t M>
[[nodiscard]] inline double chebyshev_sum(const std::array<double, M>& coefficients, double x) noexcept {
  double above = 0;
  double here = 0;
  for (std::size_t k = M - 1; k > 0; --k) {
    const double next = coefficients[k] + (2 * x * here - above);
    above = here;
    here = next;
  }
  return coefficients[0] + (x * here - above);
}

}  // namespace rmac::curves
