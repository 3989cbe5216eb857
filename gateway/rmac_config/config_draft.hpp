#pragma once

#include <functional>

#include "gateway/rmac_config/draft.hpp"
#include "gateway/rmac_config/interface_editor.hpp"
#include "gateway/rmac_config/joint_editor.hpp"
#include "gateway/rmac_config/loop_editor.hpp"
#include "gateway/rmac_config/mechanism_editor.hpp"
#include "gateway/rmac_config/spindle_editor.hpp"
#include "rmac/sdk/rmac_config.hpp"

namespace rmac::gateway {

/// RMAC_Config (dissertation 4.4): the draft of a mechanism and its editors. They check each value as far as it can be
/// checked alone; whether they fit together is found out by `apply`. Gateway thread only.
class ConfigDraft final : public sdk::RmacConfig {
 public:
  using Extent = Draft::Extent;
  struct Controller {
    /// Puts a device object in force.
    std::function<Expected<>(const sdk::DeviceObject& device, Extent extent)> apply;
    InterfaceEditor::Check check_control_interface;
    InterfaceEditor::Check check_io_interface;
  };

  explicit ConfigDraft(Controller controller);

  /// Forgets the draft and continues from `in_force`, or from nothing.
  void discard(const sdk::DeviceObject* in_force) { draft_.restart(in_force); }

  Expected<> begin(const sdk::DeviceObject& device) override;
  MechanismEditor& mechanism() override { return mechanism_; }
  JointEditor& joints() override { return joints_; }
  LoopEditor& loops() override { return loops_; }
  SpindleEditor& spindles() override { return spindles_; }
  InterfaceEditor& interfaces() override { return interfaces_; }
  [[nodiscard]] const sdk::DeviceObject& draft() const override { return draft_.device; }
  Expected<> apply() override;

 private:
  std::function<Expected<>(const sdk::DeviceObject& device, Extent extent)> apply_;
  Draft draft_;
  MechanismEditor mechanism_{draft_};
  JointEditor joints_{draft_};
  LoopEditor loops_{draft_};
  SpindleEditor spindles_{draft_};
  InterfaceEditor interfaces_;
};

}  // namespace rmac::gateway
