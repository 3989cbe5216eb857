#pragma once

#include "gateway/rmac_config/draft.hpp"
#include "rmac/sdk/config/loop_config.hpp"

namespace rmac::gateway {

/// Edits what a draft says of a joint's servo loop. A law, its gains and the method of control, in themselves, change
/// loops alone: they may go in while the machine moves. Gateway thread only.
class LoopEditor final : public sdk::LoopConfig {
 public:
  explicit LoopEditor(Draft& draft) : draft_(draft) {}

  Expected<> set_control_method(int joint, ControlMethod method) override;
  Expected<> set_servo_law(int joint, const sdk::ModuleChoice& module) override;
  Expected<> set_gains(int joint, std::span<const double> gains) override;
  Expected<> set_watch(int joint, double max_following_error, double max_effort) override;
  Expected<> set_mechanics(int joint, const JointMechanics& mechanics) override;

 private:
  Draft& draft_;
};

}  // namespace rmac::gateway
