#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// What the axis needs to follow its setpoint, as far as that is known beforehand:
///
///     effort = Kv·v + Ka·a + Fc·f + load
///
/// with v and a the wanted velocity and acceleration. Of the setpoint alone, so nothing here can make a loop unstable.
/// Friction turns round where the velocity w = v + a·lead does: f = tanh(w / friction_speed). With a presliding way δ
/// it does so over the way instead, as bristles do that bend before they slide, and stays where it is at rest: f grows
/// by way/δ, ever less as it comes near g = 1 + (breakaway - 1)·e^(-(w/stribeck_speed)²), which it ends at (Canudas de
/// Wit et al., 1995; Dupont et al., 2002: docs/derivations/two-masses.md).
///
/// A torque acts some time after it was worked out (a cycle to the drive, half a cycle of hold, the current loop);
/// `lead` is that time, by which friction turns round earlier.
class FeedforwardModel {
 public:
  struct Parameters {
    double lead_s = 0;
    double friction_speed = 0.5;  ///< mm/s or deg/s; the change of sign is spread over about this much
    double presliding = 0;        ///< mm or deg; 0: over the velocity
    double breakaway = 1;         ///< what breaks it away over what it slides with
    double stribeck_speed = 1;    ///< mm/s or deg/s at which breaking away has gone over into sliding
  };
  static constexpr std::array<GainInfo, 4> kGains{
      {{"Kv", "N·s/mm"}, {"Ka", "N·s²/mm"}, {"Friction", "N"}, {"Load", "N"}}};

  explicit FeedforwardModel(const Parameters& parameters) noexcept : parameters_(parameters) {}

  /// Kv, Ka and friction at least 0; a load of either sign.
  [[nodiscard]] static bool takes(std::span<const double, 4> gains) noexcept {
    return std::all_of(gains.begin(), gains.end(), [](double v) { return std::isfinite(v); }) &&
           std::all_of(gains.begin(), gains.begin() + 3, [](double v) { return v >= 0; });
  }
  void set_gains(std::span<const double, 4> gains) noexcept { std::copy(gains.begin(), gains.end(), gains_.begin()); }

  [[nodiscard]] double load() const noexcept { return gains_[3]; }
  /// Begins at this input, of which nobody knows what was before: the effort of the cycle that steps to it.
  [[nodiscard]] double begin(const ServoInput& input) noexcept {
    slide(input);
    FeedforwardModel next = *this;
    next.step(input);
    return next.effort(input);
  }
  /// One cycle.
  void step(const ServoInput& input) noexcept {
    if (parameters_.presliding <= 0) return slide(input);
    const double way = led(input) * input.period_s;
    // A way so long ends at g whatever it is, and is a number however small somebody has the presliding way.
    constexpr double kLongest = 1e6;
    friction_ = bent(friction_, std::clamp(way / parameters_.presliding, -kLongest, kLongest), bound(led(input)));
  }
  /// Of a joint that stands: what a feedback has to add by and by is what friction takes up, for bristles that were
  /// bent one way as the joint came to rest are bent otherwise when it goes on. Returns how much of `effort` it took.
  double settle(double effort) noexcept {
    if (parameters_.presliding <= 0 || gains_[2] <= 0) return 0;
    const double before = friction_;
    const double most = parameters_.breakaway;
    friction_ = std::clamp(friction_ + effort / gains_[2], std::min(-most, friction_), std::max(most, friction_));
    return (friction_ - before) * gains_[2];
  }
  /// After the step that was last.
  [[nodiscard]] double effort(const ServoInput& input) const noexcept {
    return gains_[0] * input.velocity_setpoint + gains_[1] * input.acceleration_setpoint + gains_[2] * friction_ +
           gains_[3];
  }

  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error,
                                 std::size_t error_size) noexcept {
    const Parameters defaults;
    return sdk::read_number(given, {"lead_s", defaults.lead_s, 0, 0.02, "s"}, parameters.lead_s, error, error_size) &&
           sdk::read_number(given, {"friction_speed", defaults.friction_speed, 1e-3, 100, "mm/s or deg/s"},
                            parameters.friction_speed, error, error_size) &&
           sdk::read_number(given, {"presliding", defaults.presliding, 0, 1, "mm or deg"}, parameters.presliding, error,
                            error_size) &&
           sdk::read_number(given, {"breakaway", defaults.breakaway, 1, 3, "times"}, parameters.breakaway, error,
                            error_size) &&
           sdk::read_number(given, {"stribeck_speed", defaults.stribeck_speed, 1e-3, 100, "mm/s or deg/s"},
                            parameters.stribeck_speed, error, error_size);
  }

 private:
  static constexpr double kGone = 40;  ///< e^-40 is nothing beside 1, and takes long to work out

  /// Largest share of friction at a speed.
  [[nodiscard]] double bound(double speed) const noexcept {
    const double share = speed / parameters_.stribeck_speed;
    return 1 + (parameters_.breakaway - 1) * (share * share < kGone ? std::exp(-share * share) : 0);
  }
  /// Friction after so many presliding ways.
  [[nodiscard]] static double bent(double friction, double way, double bound) noexcept {
    constexpr double kElastic = 0.3;  // assumed: below, bristles only bend, and nothing creeps
    const double end = std::copysign(bound, way);
    if (friction == end) return end;  // it slides, as it does most of the time
    const double slides = std::clamp(((friction + way / 2) / end - kElastic) / (1 - kElastic), 0.0, 1.0);
    // f' = 1 - slides·|f|/g, with `slides` as half of the way has it, solved: a long way ends at g.
    const double gone = slides * std::abs(way) / bound;
    const double past = gone < kGone ? -std::expm1(-gone) : 1.0;
    const double share = gone > 1e-9 ? past / gone : 1.0;
    return std::clamp(friction + way * share * (1 - slides * friction / end), -bound, bound);
  }
  void slide(const ServoInput& input) noexcept { friction_ = std::tanh(led(input) / parameters_.friction_speed); }
  /// How fast the joint is to go when this cycle's torque acts.
  [[nodiscard]] double led(const ServoInput& input) const noexcept {
    return input.velocity_setpoint + input.acceleration_setpoint * parameters_.lead_s;
  }

  Parameters parameters_;
  std::array<double, 4> gains_{};
  double friction_ = 0;  ///< shares of sliding friction; up to `breakaway` either way
};

}  // namespace rmac::modules
