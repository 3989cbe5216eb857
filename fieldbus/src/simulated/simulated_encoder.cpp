#include "rmac/fieldbus/simulated_encoder.hpp"

#include <cmath>
#include <numbers>

namespace rmac::fieldbus {

namespace {

/// SplitMix64 (Steele, Lea and Flood, 2014), from 0 to 1.
double uniform(std::uint64_t& state) noexcept {
  state += 0x9e3779b97f4a7c15;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

}  // namespace

void SimulatedEncoder::sample() noexcept {
  if (parameters_.noise_counts == 0) return;
  // Twelve uniform numbers have a variance of 1 together, and are all but normal.
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += uniform(random_);
  noise_ = parameters_.noise_counts * sum;
}

std::int32_t SimulatedEncoder::counts(double angle_rad) const noexcept {
  if (frozen_) return *frozen_;
  double counts = angle_rad * parameters_.counts_per_revolution / (2 * std::numbers::pi) + noise_;
  if (parameters_.interpolation_counts != 0)
    counts += parameters_.interpolation_counts * std::sin(parameters_.signal_periods * angle_rad);
  const auto wide = static_cast<std::int64_t>(std::floor(counts)) + offset_;
  return static_cast<std::int32_t>(static_cast<std::uint64_t>(wide));
}

std::int32_t SimulatedEncoder::counts_without_error(double angle_rad) const noexcept {
  const double counts = std::floor(angle_rad * parameters_.counts_per_revolution / (2 * std::numbers::pi));
  return static_cast<std::int32_t>(static_cast<std::uint64_t>(static_cast<std::int64_t>(counts)));
}

void SimulatedEncoder::freeze(bool frozen, double angle_rad) noexcept {
  if (!frozen) {
    frozen_.reset();
  } else if (!frozen_) {
    frozen_ = counts(angle_rad);
  }
}

}  // namespace rmac::fieldbus
