#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/animation/machine_shape.hpp"
#include "gateway/collision/ahead/clear_way.hpp"
#include "gateway/collision/ahead/guard_port.hpp"
#include "gateway/collision/setup/setup.hpp"
#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/settings/device_in_force.hpp"

namespace rmac::gateway {

/// The set-up in force, and the check that goes by it. Gateway thread only.
class CamGuard final : public GuardPort {
 public:
  CamGuard(const DeviceInForce& device, MotionSupervisor& supervisor, const MachineShape& shape)
      : device_(device), supervisor_(supervisor), shape_(shape) {}

  /// `fresh`: another mechanism, or none, so that the set-up is dropped. The same one configured anew keeps it.
  void mechanism_changed(bool fresh);
  Expected<> set_setup(const nlohmann::json& setup) override;
  [[nodiscard]] nlohmann::json setup() const override {
    return in_force_ ? in_force_->as_sent : nlohmann::json::object();
  }
  Expected<> set_check(bool on) override;
  [[nodiscard]] bool checks() const override { return supervisor_.guarding().on(); }

 private:
  struct InForce {
    nlohmann::json as_sent;
    Setup setup;
    std::vector<SceneBody> scene;
  };
  [[nodiscard]] Expected<InForce> read(const nlohmann::json& setup) const;
  [[nodiscard]] Expected<std::shared_ptr<ClearWay>> way_for(const InForce& in_force) const;
  [[nodiscard]] Expected<> clear();
  void tell_off(const std::string& why);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const MachineShape& shape_;
  std::optional<InForce> in_force_;
};

}  // namespace rmac::gateway
