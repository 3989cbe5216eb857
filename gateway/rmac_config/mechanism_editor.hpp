#pragma once

#include "gateway/rmac_config/draft.hpp"
#include "rmac/sdk/config/mechanism_config.hpp"

namespace rmac::gateway {

/// Edits what a draft says of the mechanism as a whole. Gateway thread only.
class MechanismEditor final : public sdk::MechanismConfig {
 public:
  explicit MechanismEditor(Draft& draft) : draft_(draft) {}

  Expected<> set_kinematics(const sdk::ModuleChoice& module) override;
  Expected<> set_actuator_map(const sdk::ModuleChoice& module) override;
  Expected<> set_number_of_joints(int count) override;
  Expected<> set_number_of_spindles(int count) override;
  Expected<> set_number_of_actuators(int count) override;
  Expected<> set_maximum_feedrate(double mm_min) override;
  Expected<> set_actuators(std::span<const sdk::Actuator> actuators) override;
  Expected<> set_spindles(std::span<const sdk::Spindle> spindles) override;

 private:
  Draft& draft_;
};

}  // namespace rmac::gateway
