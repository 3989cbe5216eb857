#include "gateway/rmac/simulator/shaped_machine.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/rmac/simulator/machine_modules.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

Expected<gateway::LinkChain> chain_of(const gateway::DeviceDatabase& database, const fs::path& device_json,
                                      const fs::path& device_tree) {
  const sdk::DeviceObject& device = database.device;
  const auto kinematics = loader_of(device, device_json, device_tree).load<Kinematics>(device.kinematics);
  if (!kinematics) return tl::unexpected(kinematics.error());
  std::vector<JointLimits> joints;
  for (const sdk::Joint& joint : device.joints) joints.push_back(joint.limits);
  return gateway::LinkChain::make(*kinematics->object, database.bodies.chain, joints);
}

}  // namespace

Result<ShapedMachine> read_shaped_machine(const std::string& machine, const fs::path& device_tree,
                                          const char* without) {
  const auto device_json = gateway::find_device_json(machine, device_tree);
  if (!device_json) return fail(device_json.error().message);
  auto database = gateway::read_device_json(*device_json);
  if (!database) return fail(database.error().message);
  if (database->bodies.bodies.empty()) {
    return fail(fmt::format("{}: has no Geometry, so that {}", device_json->string(), without));
  }
  auto chain = chain_of(*database, *device_json, device_tree);
  if (!chain) return fail(fmt::format("{}: {}", device_json->string(), chain.error().message));
  return ShapedMachine{database->device.name, std::move(database->bodies), std::move(*chain)};
}

}  // namespace rmac::cli
