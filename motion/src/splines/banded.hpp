#pragma once

#include <cstddef>
#include <vector>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// A symmetric positive matrix with `band` diagonals on either side of the main one; solved by LDLᵀ.
class Banded {
 public:
  Banded(std::size_t size, std::size_t band) : size_(size), band_(band), values_(size * (band + 1), 0.0) {}

  /// Entry (row, row - below).
  [[nodiscard]] double& at(std::size_t row, std::size_t below) { return values_[row * (band_ + 1) + below]; }
  [[nodiscard]] double at(std::size_t row, std::size_t below) const { return values_[row * (band_ + 1) + below]; }

  /// Gives an unknown its value: its row becomes trivial, and its column goes to the right side.
  template <class T>
  void fix(std::size_t index, const T& value, std::vector<T>& right) {
    for (std::size_t k = 1; k <= band_; ++k) {
      if (index >= k) take(at(index, k), value, right[index - k]);
      if (index + k < size_) take(at(index + k, k), value, right[index + k]);
    }
    at(index, 0) = 1;
    right[index] = value;
  }

  /// Replaces the entries by those of L and D; false where the matrix is not positive. Column by column, each taken off
  /// what lies behind it: the inner loop goes over neighbours in memory.
  [[nodiscard]] bool factorise() {
    std::vector<double> column(band_);
    for (std::size_t j = 0; j < size_; ++j) {
      const double diagonal = at(j, 0);
      if (!(diagonal > 0)) return false;
      const double inverse = 1 / diagonal;
      const std::size_t most = band_ < size_ - 1 - j ? band_ : size_ - 1 - j;
      // The last first, as the entries of a row stand.
      for (std::size_t k = 1; k <= most; ++k) column[most - k] = at(j + k, k);
      for (std::size_t k = 1; k <= most; ++k) {
        double* const row = &at(j + k, 0);
        const double* const reversed = column.data() + (most - k);
        const double factor = row[k] * inverse;
        for (std::size_t below = 0; below < k; ++below) row[below] -= factor * reversed[below];
        row[k] = factor;
      }
    }
    return true;
  }

  /// Replaces right sides, numbers or vectors, by the solution; after `factorise`.
  template <class T>
  void substitute(std::vector<T>& right) const {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 1; k <= band_ && k <= i; ++k) subtract(at(i, k), right[i - k], right[i]);
    }
    for (std::size_t i = size_; i-- > 0;) {
      divide(right[i], at(i, 0));
      for (std::size_t k = 1; k <= band_ && i + k < size_; ++k) subtract(at(i + k, k), right[i + k], right[i]);
    }
  }

 private:
  static void subtract(double factor, double from, double& to) { to -= factor * from; }
  static void subtract(double factor, const Vector& from, Vector& to) {
    for (std::size_t c = 0; c < 3; ++c) to[c] -= factor * from[c];
  }
  static void divide(double& value, double by) { value /= by; }
  static void divide(Vector& value, double by) {
    for (double& v : value) v /= by;
  }
  template <class T>
  static void take(double& entry, const T& value, T& right) {
    subtract(entry, value, right);
    entry = 0;
  }

  std::size_t size_;
  std::size_t band_;
  std::vector<double> values_;
};

}  // namespace rmac
