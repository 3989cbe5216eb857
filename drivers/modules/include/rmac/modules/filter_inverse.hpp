#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <span>
#include <vector>

#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// What makes up in front of a joint's notches and low-pass, whose product is F, for what they will take away, at no
/// frequency more than `kMost` times: the stable G with |G|² = 1 / (|F|² + 1 / kMost²). What it makes of a steady sine
/// is no larger behind them than the sine. Its steps are real-time safe; the first finds its poles. Where those are not
/// found, as with many notches at one place, nothing is made larger.
class FilterInverse {
 public:
  static constexpr double kMost = 10;
  static constexpr std::size_t kMostNotches = 8;  ///< what a cycle has time for

  /// As `Resonances` and `LowPass` of device.json have them.
  struct Notch {
    double frequency_hz, damping, width;
  };
  struct Parameters {
    std::vector<Notch> notches{};
    double low_pass_hz = 0;  ///< 0: none
  };

  explicit FilterInverse(const Parameters& parameters) {
    for (const Notch& notch : parameters.notches) {
      filters_.push_back({notch.frequency_hz, notch.damping, notch.width, false});
    }
    if (parameters.low_pass_hz > 0) filters_.push_back({parameters.low_pass_hz, 0, std::numbers::sqrt2 / 2, true});
    const std::size_t order = 2 * filters_.size();
    sections_.reserve(order);
    roots_.reserve(order);
    for (auto* polynomial : {&numerator_, &denominator_}) polynomial->reserve(order + 1);
  }

  /// `sweep_notches`, a frequency (Hz), a damping and a width for each, and `sweep_low_pass_hz`; false, with the reason
  /// in `error`, where they are no filters.
  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error, std::size_t error_size) {
    const std::span<const double> numbers = sdk::find_numbers(given, "sweep_notches");
    bool fine = numbers.size() % 3 == 0 && numbers.size() <= 3 * kMostNotches;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Notch& notch = parameters.notches.emplace_back(Notch{numbers[i], numbers[i + 1], numbers[i + 2]});
      fine = fine && std::isfinite(notch.frequency_hz) && notch.frequency_hz > 0 && notch.damping > 0 &&
             notch.damping <= notch.width && std::isfinite(notch.width);
    }
    if (!fine) {
      std::snprintf(error, error_size,
                    "parameter sweep_notches must have a frequency in Hz, a damping above 0 and a width of at least "
                    "that for each notch, of which there may be %zu",
                    kMostNotches);
    }
    return fine &&
           sdk::read_number(given, {"sweep_low_pass_hz", 0, 0, 1e6, "Hz"}, parameters.low_pass_hz, error, error_size);
  }

  /// Effort of this cycle, whose period is always the same. What lies beyond half the sampling rate is left out.
  [[nodiscard]] double step(double effort, double period_s) noexcept {
    if (!designed_) design(period_s);
    Complex made = scale_ * effort;
    for (Section& section : sections_) made = section.step(made);
    return made.real();
  }

 private:
  using Complex = std::complex<double>;

  /// Of EffortFilter, with its p; a low-pass has 1 as its numerator.
  struct Filter {
    double frequency_hz, zero_damping, pole_damping;
    bool is_low_pass;
  };

  /// (1 - P/zero) / (1 - P/pole), with P = (q - 1) / (q + 1), q one cycle ahead. Complex ones come in pairs, which are
  /// real together.
  struct Section {
    Complex zero, pole;
    Complex x1 = 0, y1 = 0;

    Complex step(Complex x) noexcept {
      const Complex y =
          ((1.0 - 1.0 / zero) * x + (1.0 + 1.0 / zero) * x1 - (1.0 + 1.0 / pole) * y1) / (1.0 - 1.0 / pole);
      x1 = x;
      return y1 = y;
    }
  };

  /// Polynomials of u = -P² / unit, lowest power first: |1 + 2 d p + p²|² is 1 + (4 d² - 2) |p|² + |p|⁴.
  using Polynomial = std::vector<double>;

  static void multiply(Polynomial& all, double first, double second) noexcept {
    all.push_back(0);
    all.push_back(0);
    for (std::size_t i = all.size(); i-- > 0;) {
      all[i] += (i > 0 ? first * all[i - 1] : 0) + (i > 1 ? second * all[i - 2] : 0);
    }
  }

  /// The poles of G are where |numerator|² + |denominator|² / kMost² of F is 0, its zeros are the poles of F.
  void design(double period_s) noexcept {
    designed_ = true;
    const auto corner = [period_s](const Filter& one) {
      return std::tan(std::numbers::pi * one.frequency_hz * period_s);
    };
    std::erase_if(filters_, [period_s](const Filter& one) { return 2 * one.frequency_hz * period_s >= 1; });
    if (filters_.empty()) return;
    double unit = 1;
    for (const Filter& one : filters_) unit *= std::pow(corner(one), 2.0 / static_cast<double>(filters_.size()));
    numerator_.assign(1, 1);
    denominator_.assign(1, 1);
    for (const Filter& one : filters_) {
      const double w = corner(one), u = unit / (w * w), z = one.zero_damping, d = one.pole_damping;
      multiply(denominator_, (4 * d * d - 2) * u, u * u);
      if (one.is_low_pass) {
        multiply(numerator_, 0, 0);
      } else {
        multiply(numerator_, (4 * z * z - 2) * u, u * u);
      }
      const Complex turn = d < 1 ? Complex(-d, std::sqrt(1 - d * d)) : Complex(-d + std::sqrt(d * d - 1), 0);
      // What the poles would be with this filter alone, from where all are sought; no two begin at one place.
      const double alone = std::min(std::hypot(z, d / kMost), 0.99);
      const Complex begin =
          one.is_low_pass ? w * std::sqrt(kMost) * turn : w * Complex(-alone, std::sqrt(1 - alone * alone));
      const double apart = 1 + 0.01 * static_cast<double>(roots_.size());
      for (const bool conjugate : {false, true}) {
        const Complex zero = w * (conjugate ? 1.0 / turn : turn);
        sections_.push_back({zero, zero});
        const Complex root = -begin * begin * apart / unit;
        roots_.push_back(conjugate ? std::conj(root) : root);
      }
    }
    for (std::size_t i = 0; i < numerator_.size(); ++i) numerator_[i] += denominator_[i] / (kMost * kMost);
    if (!find_roots()) {
      sections_.clear();
      return;
    }
    for (std::size_t i = 0; i < sections_.size(); ++i) sections_[i].pole = -std::sqrt(-unit * roots_[i]);
    scale_ = 1 / std::sqrt(1 + 1 / (kMost * kMost));
  }

  /// Of `numerator_`, all at a time (Weierstrass, Durand and Kerner); false where they are not found.
  [[nodiscard]] bool find_roots() noexcept {
    constexpr int kMostRounds = 100;
    constexpr double kExact = 1e-6;
    for (int round = 0; round < kMostRounds; ++round) {
      double farthest = 0;
      for (std::size_t i = 0; i < roots_.size(); ++i) {
        Complex value = 0, others = numerator_.back();
        for (std::size_t k = numerator_.size(); k-- > 0;) value = value * roots_[i] + numerator_[k];
        for (std::size_t k = 0; k < roots_.size(); ++k) {
          if (k != i) others *= roots_[i] - roots_[k];
        }
        const Complex off = value / others;
        if (!std::isfinite(std::abs(off))) return false;
        roots_[i] -= off;
        farthest = std::max(farthest, std::abs(off / roots_[i]));
      }
      if (farthest < kExact) return true;
    }
    return false;
  }

  std::vector<Filter> filters_;
  std::vector<Section> sections_;
  std::vector<Complex> roots_;
  Polynomial numerator_, denominator_;
  double scale_ = 1;
  bool designed_ = false;
};

}  // namespace rmac::modules
