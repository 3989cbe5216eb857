#pragma once

#include <vector>

#include "gateway/rmac_cam/settings/device_in_force.hpp"
#include "rmac/sdk/cam/joint_settings.hpp"

namespace rmac::gateway {

/// Keeps speed and accelerations for the next joint move, bounded by the joints' limits. Gateway thread only.
class CamJointSettings final : public sdk::JointSettings {
 public:
  struct Values {
    double interp_percent = 100;  ///< of each joint's speed limit
    std::vector<double> accel_rise, accel_fall;
  };

  explicit CamJointSettings(const DeviceInForce& device) : device_(device) {}

  /// The joints' limits are in force again. `fresh`: it is another mechanism, and the speed starts anew too.
  void mechanism_changed(bool fresh);

  Expected<> set_interp_speed(double percent) override;
  [[nodiscard]] double interp_speed() const override { return values_.interp_percent; }
  Expected<> set_accel_rise(int joint, double value) override;
  [[nodiscard]] Expected<double> accel_rise(int joint) const override;
  Expected<> set_accel_fall(int joint, double value) override;
  [[nodiscard]] Expected<double> accel_fall(int joint) const override;

  [[nodiscard]] const Values& values() const noexcept { return values_; }
  /// Puts in force again what was before.
  void take_up(const Values& values) { values_ = values; }

 private:
  [[nodiscard]] Expected<> set(std::vector<double>& accelerations, const char* function, int joint, double value);

  const DeviceInForce& device_;
  Values values_;
};

}  // namespace rmac::gateway
