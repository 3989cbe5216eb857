#pragma once

#include <cstdint>

#include "gateway/rmac_cam/settings/device_in_force.hpp"
#include "gateway/servo/cycle_history.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/sdk/cam/path_settings.hpp"

namespace rmac::gateway {

/// Keeps feed, accelerations and tolerances for the next path move, bounded by the mechanism. Gateway thread only.
class CamPathSettings final : public sdk::PathSettings {
 public:
  struct Values {
    double feedrate_mm_min = 0;  ///< 0: none is set
    double max_feedrate_mm_min = 0;
    double accel_rise_mm_s2 = 0;  ///< 0: the joints alone bound it
    double accel_fall_mm_s2 = 0;
    double tolerance_mm = 0;
    double orientation_tolerance_deg = kOrientationTolerance_deg;
  };

  CamPathSettings(const DeviceInForce& device, const CycleHistory& history) : device_(device), history_(history) {}

  /// The mechanism's largest feed is the new bound of ours, upwards too. `fresh`: it is another one, and everything
  /// starts anew.
  void mechanism_changed(bool fresh);

  Expected<> set_feedrate(double mm_min) override;
  [[nodiscard]] double feedrate() const override;
  Expected<> set_max_feedrate(double mm_min) override;
  [[nodiscard]] double max_feedrate() const override { return values_.max_feedrate_mm_min; }
  Expected<> set_accel_rise(double mm_s2) override;
  [[nodiscard]] double accel_rise() const override { return values_.accel_rise_mm_s2; }
  Expected<> set_accel_fall(double mm_s2) override;
  [[nodiscard]] double accel_fall() const override { return values_.accel_fall_mm_s2; }
  Expected<> set_tolerance(double mm) override;
  [[nodiscard]] double tolerance() const override { return values_.tolerance_mm; }
  Expected<> set_orientation_tolerance(double degrees) override;
  [[nodiscard]] double orientation_tolerance() const override { return values_.orientation_tolerance_deg; }

  /// Refuses a move along the path where no feed is in force, or one above the maximum.
  [[nodiscard]] Expected<> check_feed(std::int64_t move_id) const;
  [[nodiscard]] double feed_mm_s() const noexcept;
  [[nodiscard]] double max_feed_mm_s() const noexcept;
  [[nodiscard]] const Values& values() const noexcept { return values_; }
  /// Puts in force again what was before, as far as the mechanism lets it.
  void take_up(const Values& values);

 private:
  const DeviceInForce& device_;
  const CycleHistory& history_;
  Values values_;
};

/// Refuses an acceleration that is none, or above `bound`, where there is one; mm/s² or degrees/s².
[[nodiscard]] Expected<> check_acceleration(const char* function, double value, double bound);

}  // namespace rmac::gateway
