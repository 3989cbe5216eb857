#include "servo/joints/position_correction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rmac/motion/servo/pitch_error.hpp"

namespace rmac {

namespace {
// A table steeper than this would hide a wrong scale, and its inverse would not settle.
constexpr double kSteepest = 0.1;
// Above this share of the sampling frequency a filter is no longer what its name says.
constexpr double kHighestShare = 0.4;
constexpr double kLowestFilter_hz = 1;  ///< below it a filter holds back what holds the joint
}  // namespace

PositionCorrection::PositionCorrection(const JointMechanics& mechanics)
    : pitch_(mechanics.pitch), half_backlash_(mechanics.backlash / 2) {}

void PositionCorrection::set_side(double side) noexcept {
  side_ = from_ = to_ = std::clamp(side, -1.0, 1.0);
  side_rate_ = side_acceleration_ = 0;
  crossed_s_ = kCrossingS;
}

void PositionCorrection::follow(double wanted_velocity, double period_s) noexcept {
  const double wanted = std::abs(wanted_velocity) > kStanding ? std::copysign(1.0, wanted_velocity) : to_;
  if (wanted != to_) {
    from_ = side_;
    to_ = wanted;
    crossed_s_ = 0;
  }
  if (crossed_s_ >= kCrossingS) return set_side(to_);
  crossed_s_ = std::min(crossed_s_ + period_s, kCrossingS);
  const double angle = 2 * std::numbers::pi * crossed_s_ / kCrossingS;
  const double way = to_ - from_;
  side_ = from_ + way * (angle - std::sin(angle)) / (2 * std::numbers::pi);
  side_rate_ = way * (1 - std::cos(angle)) / kCrossingS;
  side_acceleration_ = way * 2 * std::numbers::pi * std::sin(angle) / (kCrossingS * kCrossingS);
}

double PositionCorrection::error(double shown) const noexcept {
  return pitch_error(pitch_, shown);
}

double PositionCorrection::slope(double shown) const noexcept {
  if (pitch_.errors.size() < 2) return 0;
  const std::size_t last = pitch_.errors.size() - 1;
  const double along = (shown - pitch_.first) / pitch_.step;
  if (!(along >= 0 && along <= static_cast<double>(last))) return 0;
  const std::size_t index = std::min(static_cast<std::size_t>(along), last - 1);
  return (pitch_.errors[index + 1] - pitch_.errors[index]) / pitch_.step;
}

double PositionCorrection::shown(double actual) const noexcept {
  const double on_flank = actual + side_ * half_backlash_;
  double shown = on_flank - error(on_flank);
  if (pitch_.errors.size() < 2) return shown;
  // Each pass shrinks the miss to a tenth at least.
  for (int pass = 1; pass < 16; ++pass) shown = on_flank - error(shown);
  return shown;
}

Expected<> check_mechanics(const JointMechanics& mechanics, double period_s, const std::string& who) {
  const auto refuse = [&who](const std::string& why) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: " + who + ": " + why);
  };
  const PitchErrors& pitch = mechanics.pitch;
  if (!std::isfinite(pitch.first) || (!pitch.errors.empty() && !(pitch.step > 0 && std::isfinite(pitch.step)))) {
    return refuse("the pitch-error table needs a first position, and a step above 0");
  }
  for (std::size_t i = 0; i < pitch.errors.size(); ++i) {
    const double change = i == 0 ? 0 : pitch.errors[i] - pitch.errors[i - 1];
    if (!std::isfinite(pitch.errors[i]) || std::abs(change) > kSteepest * pitch.step) {
      return refuse("the pitch-error table changes by more than a tenth of its step at point " + std::to_string(i));
    }
  }
  if (!(mechanics.backlash >= 0 && mechanics.backlash <= 10)) {
    return refuse("a backlash must be 0 to 10 mm or degrees");
  }
  const double highest = kHighestShare / period_s;
  for (const Resonance& resonance : mechanics.resonances) {
    if (!(resonance.frequency_hz >= kLowestFilter_hz && resonance.frequency_hz <= highest) ||
        !(resonance.damping > 0) || !(resonance.damping < resonance.width) || !(resonance.width <= 2)) {
      return refuse("a resonance needs a frequency of 1 to " + std::to_string(highest) +
                    " Hz, a damping above 0, and a width above the damping, at most 2");
    }
  }
  const double corner = mechanics.low_pass_hz;
  if (corner != 0 && !(corner >= kLowestFilter_hz && corner <= highest)) {
    return refuse("the low-pass must be 0 (none), or 1 to " + std::to_string(highest) + " Hz");
  }
  return {};
}

}  // namespace rmac
