#pragma once

#include "gateway/rmac_config/draft.hpp"
#include "rmac/sdk/config/spindle_config.hpp"

namespace rmac::gateway {

/// Edits what a draft says of a spindle. Gateway thread only.
class SpindleEditor final : public sdk::SpindleConfig {
 public:
  explicit SpindleEditor(Draft& draft) : draft_(draft) {}

  Expected<> set_maximum_rpm(int spindle, double rpm) override;
  Expected<> set_maximum_torque(int spindle, double torque_nm) override;
  Expected<> set_control_method(int spindle, ControlMethod method) override;
  Expected<> set_servo_law(int spindle, const sdk::ModuleChoice& module) override;
  Expected<> set_gains(int spindle, std::span<const double> gains) override;

 private:
  Draft& draft_;
};

}  // namespace rmac::gateway
