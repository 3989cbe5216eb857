#include "gateway/mechanism/assembler.hpp"

#include "gateway/mechanism/device_check.hpp"
#include "gateway/mechanism/loop_draft.hpp"

namespace rmac::gateway {

Expected<std::shared_ptr<ServoLaw>> load_joint_law(const sdk::Joint& joint, const ModuleLoader& loader,
                                                   std::vector<ModuleInUse>& modules) {
  return load_law(joint.servo_law, joint.gains, "joint " + joint.limits.name, loader, modules);
}

Expected<std::shared_ptr<Mechanism>> assemble(const sdk::DeviceObject& device, const AssemblyOptions& options,
                                              const ModuleLoader& loader, BusRegistry& registry) {
  LoopDraft draft{device, loader, registry};
  ServoLoopParts& parts = draft.parts;
  parts.period_s = options.period_s;
  parts.virtual_mode = options.virtual_mode;
  parts.stop_categories = options.stop_categories;
  parts.max_cycles_lost = options.max_cycles_lost;
  auto ready = check_device(device);
  for (const auto add : {add_geometry, add_joints, add_drives, add_spindles, add_sensors, add_io}) {
    if (ready) ready = add(draft);
  }
  if (!ready) return tl::unexpected(ready.error());

  PlannerModel model;
  model.kinematics = parts.kinematics;
  for (const sdk::Joint& joint : device.joints) model.joints.push_back(joint.limits);
  model.period_s = options.period_s;
  model.max_feed_mm_s = device.max_feedrate_mm_min / 60;
  auto loop = ServoLoop::create(std::move(parts));
  if (!loop) return tl::unexpected(loop.error());
  return std::make_shared<Mechanism>(device, std::move(model), std::shared_ptr<ServoLoop>(std::move(*loop)),
                                     std::move(draft.modules));
}

ModuleLoader Assembler::loader(const std::string& mechanism_folder) const {
  std::vector<std::filesystem::path> folders;
  if (!mechanism_folder.empty()) folders.emplace_back(mechanism_folder);
  folders.insert(folders.end(), module_folders_.begin(), module_folders_.end());
  return ModuleLoader(std::move(folders));
}

Expected<std::shared_ptr<Mechanism>> Assembler::assemble(const sdk::DeviceObject& device,
                                                         const MechanismSource& source) const {
  AssemblyOptions options = options_;
  options.virtual_mode = source.virtual_mode;
  return gateway::assemble(device, options, loader(source.folder), registry_);
}

}  // namespace rmac::gateway
