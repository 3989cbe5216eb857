#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace rmac {

/// How the words of one drive become shaft values: counts to rad, per mille of rated torque to N·m.
struct DriveScale {
  double counts_per_revolution = 0;
  double rated_torque_nm = 0;
  int direction = 1;             ///< +1 or -1: the shaft's sense against the drive's
  std::int32_t home_counts = 0;  ///< encoder reading where the shaft angle is zero
};

/// The shaft's angle where the drive's encoder reads `counts`, in rad. Real-time safe, as all that follows.
[[nodiscard]] inline double shaft_rad(const DriveScale& scale, double counts) noexcept {
  return scale.direction * (counts - scale.home_counts) * (2 * std::numbers::pi / scale.counts_per_revolution);
}

/// What the encoder reads where the shaft is at `rad`, before rounding: the inverse of `shaft_rad`.
[[nodiscard]] inline double shaft_counts(const DriveScale& scale, double rad) noexcept {
  return scale.home_counts + scale.direction * rad * (scale.counts_per_revolution / (2 * std::numbers::pi));
}

/// Turns of the shaft in so many counts; home plays no part in a difference.
[[nodiscard]] inline double shaft_turns(const DriveScale& scale, std::int64_t counts) noexcept {
  return static_cast<double>(scale.direction * counts) / scale.counts_per_revolution;
}

/// Torque at the shaft, in its sense, for a drive's torque word (6071h, 6077h).
[[nodiscard]] inline double shaft_nm(const DriveScale& scale, std::int16_t permille) noexcept {
  return scale.direction * permille * scale.rated_torque_nm / 1000;
}

/// The word that asks for this torque at the shaft, within what the word holds.
[[nodiscard]] inline std::int16_t torque_word(const DriveScale& scale, double shaft_nm) noexcept {
  constexpr double kMost = 32767;
  const double permille = scale.direction * shaft_nm * 1000 / scale.rated_torque_nm;
  return static_cast<std::int16_t>(std::lround(permille < -kMost ? -kMost : permille > kMost ? kMost : permille));
}

/// A drive's position word wraps at 32 bits. How far it went from `before` to `now`, by the nearer way.
[[nodiscard]] inline std::int32_t counts_gone(std::int64_t before, std::int32_t now) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(before));
}

/// The word for a position in unwrapped counts.
[[nodiscard]] inline std::int32_t position_word(double counts) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(counts))));
}

}  // namespace rmac
