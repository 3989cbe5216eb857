#pragma once

#include "gateway/rmac_config/draft.hpp"
#include "rmac/sdk/config/joint_config.hpp"

namespace rmac::gateway {

/// Edits what a draft says of a joint's travel and bounds. Gateway thread only.
class JointEditor final : public sdk::JointConfig {
 public:
  explicit JointEditor(Draft& draft) : draft_(draft) {}

  Expected<> set_name(int joint, std::string_view name) override;
  Expected<> set_type(int joint, JointType type) override;
  Expected<> set_limit_type(int joint, JointLimitType type) override;
  Expected<> set_maximum_limit(int joint, double value) override;
  Expected<> set_minimum_limit(int joint, double value) override;
  Expected<> set_maximum_speed(int joint, double value) override;
  Expected<> set_maximum_acceleration(int joint, double value) override;
  Expected<> set_maximum_jerk(int joint, double value) override;

 private:
  /// A limit that device.json calls `key`.
  [[nodiscard]] Expected<> set(int joint, const char* function, const char* key, double value,
                               double JointLimits::*member);

  Draft& draft_;
};

}  // namespace rmac::gateway
