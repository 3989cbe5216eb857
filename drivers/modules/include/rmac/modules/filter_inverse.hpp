#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <vector>

#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// What makes up in front of a joint's notches and low-pass for what they will take away, as far as ten times: the
/// inverse of each, whose own poles are damped so much that it is stable and no larger. Made off the cycle; its steps
/// are real-time safe.
class FilterInverse {
 public:
  static constexpr double kMost = 10;

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
      sections_.push_back({notch.frequency_hz, notch.width, std::max(notch.damping, notch.width / kMost), 1});
    }
    constexpr double kButterworth = std::numbers::sqrt2 / 2;
    if (parameters.low_pass_hz > 0) {
      sections_.push_back({parameters.low_pass_hz, kButterworth, kButterworth, std::sqrt(kMost)});
    }
  }

  /// `sweep_notches`, a frequency (Hz), a damping and a width for each, and `sweep_low_pass_hz`; false, with the reason
  /// in `error`, where they are no filters.
  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error, std::size_t error_size) {
    const std::span<const double> numbers = sdk::find_numbers(given, "sweep_notches");
    bool fine = numbers.size() % 3 == 0;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Notch& notch = parameters.notches.emplace_back(Notch{numbers[i], numbers[i + 1], numbers[i + 2]});
      fine = fine && std::isfinite(notch.frequency_hz) && notch.frequency_hz > 0 && notch.damping > 0 &&
             notch.damping <= notch.width && std::isfinite(notch.width);
    }
    if (!fine) {
      std::snprintf(error, error_size,
                    "parameter sweep_notches must have a frequency in Hz, a damping above 0 and a width of at least "
                    "that for each notch");
    }
    return fine &&
           sdk::read_number(given, {"sweep_low_pass_hz", 0, 0, 1e6, "Hz"}, parameters.low_pass_hz, error, error_size);
  }

  /// Effort of this cycle, whose period is always the same. What lies beyond half the sampling rate is left out.
  [[nodiscard]] double step(double effort, double period_s) noexcept {
    for (Section& section : sections_) {
      if (2 * section.frequency_hz * period_s < 1) effort = section.step(effort, period_s);
    }
    return effort;
  }

 private:
  /// (p² + 2 z p + 1) / ((p/k)² + 2 d p/k + 1), with p of EffortFilter: the numerator is its section's denominator.
  struct Section {
    double frequency_hz, zero_damping, pole_damping, farther;
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;

    double step(double x, double period_s) noexcept {
      const double w = std::tan(std::numbers::pi * frequency_hz * period_s), v = w * farther;
      const double over = v * v / (w * w) / (1 + 2 * pole_damping * v + v * v);
      const double y =
          over * ((1 + 2 * zero_damping * w + w * w) * x + 2 * (w * w - 1) * x1 +
                  (1 - 2 * zero_damping * w + w * w) * x2) -
          (2 * (v * v - 1) * y1 + (1 - 2 * pole_damping * v + v * v) * y2) / (1 + 2 * pole_damping * v + v * v);
      x2 = x1;
      x1 = x;
      y2 = y1;
      return y1 = y;
    }
  };

  std::vector<Section> sections_;
};

}  // namespace rmac::modules
