#pragma once

#include <memory>
#include <vector>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/modules/module_loader.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// A servo loop in the making: what it is made of so far, and where the rest comes from.
struct LoopDraft {
  const sdk::DeviceObject& device;
  const ModuleLoader& loader;
  BusRegistry& registry;
  ServoLoopParts parts{};
  std::vector<ModuleInUse> modules{};
};

// Each adds its part to a draft that holds those of the functions above it; an error says what of the device object
// does not fit. Gateway thread.

/// Kinematics and actuator map, which must fit each other and the joints.
[[nodiscard]] Expected<> add_geometry(LoopDraft& draft);
/// The loop of each joint, with its law.
[[nodiscard]] Expected<> add_joints(LoopDraft& draft);
/// Drives behind joints, on their buses, which come up here.
[[nodiscard]] Expected<> add_drives(LoopDraft& draft);
/// Drives of spindles, with their laws.
[[nodiscard]] Expected<> add_spindles(LoopDraft& draft);
/// Force sensors of joints.
[[nodiscard]] Expected<> add_sensors(LoopDraft& draft);
/// Digital inputs and outputs, those that drives tell included, and what the loop does on them by itself.
[[nodiscard]] Expected<> add_io(LoopDraft& draft);

/// The law that `choice` names, with these gains; adds its module to `modules`. `who` is for errors: "joint X".
[[nodiscard]] Expected<std::shared_ptr<ServoLaw>> load_law(const sdk::ModuleChoice& choice,
                                                           const std::vector<double>& gains, const std::string& who,
                                                           const ModuleLoader& loader,
                                                           std::vector<ModuleInUse>& modules);

}  // namespace rmac::gateway
