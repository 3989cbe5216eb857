#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "rmac/modules/fuzzy_surface.hpp"
#include "rmac/modules/pid_feedback.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// Fuzzy law: effort = load + U · surface(e / E, ė / V) + ∫ Ki·E/2 · surface(e / E, 0) dt. Close to rest it acts as a
/// PID with Kp = 2 U/E, Ki, and Kd = 2 U/V; further out it is softer, and what error and rate add ends at U. U must
/// therefore be more than load and friction can suddenly ask for.
class FuzzyServoLaw final : public ServoLaw {
 public:
  FuzzyServoLaw(const ErrorSignal::Parameters& signal, double load) noexcept : signal_(signal), load_(load) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size()) return false;
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v >= 0; })) return false;
    if (!std::all_of(values.begin(), values.begin() + 3, [](double v) { return std::isnormal(v); })) return false;
    const double before = surface();
    error_range_ = values[0];
    rate_range_ = values[1];
    effort_range_ = values[2];
    integral_.set_gain(values[3]);
    integral_.shift(before - surface());
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  [[nodiscard]] double resting_effort() const noexcept override { return load_; }

  void engage(const ServoInput& input, double effort) noexcept override {
    signal_.engage(input);
    integral_.start(std::clamp(effort, -limit_, limit_), load_ + surface(), softened_error(), input.period_s);
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    signal_.update(input);
    return integral_.output(load_ + surface(), softened_error(), input.period_s, limit_);
  }

 private:
  static constexpr std::array<GainInfo, 4> kGains{
      {{"ErrorRange", "mm"}, {"RateRange", "mm/s"}, {"EffortRange", "N"}, {"Ki", "N/(mm·s)"}}};

  [[nodiscard]] double surface() const noexcept {
    return effort_range_ * FuzzySurface::at(signal_.error() / error_range_, signal_.rate() / rate_range_);
  }

  /// As the surface weighs it against effort: an integral of the plain error would outgrow the rest far from rest.
  [[nodiscard]] double softened_error() const noexcept {
    if (signal_.rests()) return 0;
    return error_range_ / FuzzySurface::kCentreSlope * FuzzySurface::at(signal_.error() / error_range_, 0);
  }

  ErrorSignal signal_;
  double load_;
  IntegralAction integral_;
  double error_range_ = 1, rate_range_ = 1;
  double effort_range_ = 0;
  double limit_ = 0;
};

/// Makes a `FuzzyServoLaw`; parameters `derivative_filter_s`, `rest_band` and `load`.
struct FuzzyServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters, {"derivative_filter_s", "rest_band", "load"}, error, error_size))
      return nullptr;
    ErrorSignal::Parameters signal;
    double load = 0;
    if (!ErrorSignal::read(parameters, signal, error, error_size)) return nullptr;
    if (!sdk::read_number(parameters, kLoad, load, error, error_size)) return nullptr;
    return new FuzzyServoLaw(signal, load);
  }
};

}  // namespace rmac::modules
