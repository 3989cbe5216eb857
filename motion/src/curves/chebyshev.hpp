#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

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
    polynomial_[0][0] = polynomial_[1][1] = 1;
    for (std::size_t k = 2; k <= N; ++k) {
      for (std::size_t i = 0; i <= N; ++i)
        polynomial_[k][i] = (i > 0 ? 2 * polynomial_[k - 1][i - 1] : 0) - polynomial_[k - 2][i];
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

  /// The same polynomial's coefficients of x^k. Good where Chebyshev's fall off quickly: those of a high power then are
  /// small, however many of them make it up.
  [[nodiscard]] Values powers(const Values& coefficients) const noexcept {
    Values result{};
    for (std::size_t k = 0; k <= N; ++k) {
      for (std::size_t i = 0; i <= N; ++i) result[i] += coefficients[k] * polynomial_[k][i];
    }
    return result;
  }

 private:
  std::array<Values, N + 1> cosine_{};
  std::array<Values, N + 1> polynomial_{};  ///< Chebyshev's k-th, by powers
};

/// Clenshaw's sums of Chebyshev coefficients at several places: one alone would have to wait for each of its terms.
template <std::size_t M>
[[nodiscard]] inline std::array<double, M> chebyshev_sums(std::span<const double> coefficients,
                                                          const std::array<double, M>& x) noexcept {
  std::array<double, M> above{}, here{};
  for (std::size_t k = coefficients.size() - 1; k > 0; --k) {
    for (std::size_t i = 0; i < M; ++i) {
      const double next = coefficients[k] + (2 * x[i] * here[i] - above[i]);
      above[i] = here[i];
      here[i] = next;
    }
  }
  for (std::size_t i = 0; i < M; ++i) here[i] = coefficients[0] + (x[i] * here[i] - above[i]);
  return here;
}

/// Sum of coefficients of x^k, as many even as odd ones, which need not wait for each other.
template <std::size_t M>
[[nodiscard]] inline double power_sum(const std::array<double, M>& coefficients, double x) noexcept {
  static_assert(M % 2 == 0);
  double even = coefficients[M - 2], odd = coefficients[M - 1];
  for (std::size_t k = M - 2; k > 0; k -= 2) {
    even = even * (x * x) + coefficients[k - 2];
    odd = odd * (x * x) + coefficients[k - 1];
  }
  return even + x * odd;
}

}  // namespace rmac::curves
