#include "gateway/rmac/simulator/collision_watch.hpp"

#include <fmt/format.h>

#include <utility>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/modules/module_loader.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

/// Where joints without ends are compared with the module.
constexpr double kEndless = 400;

Expected<gateway::LinkChain> chain_of(const gateway::DeviceDatabase& database, const fs::path& device_json,
                                      const fs::path& device_tree) {
  const sdk::DeviceObject& device = database.device;
  std::vector<fs::path> folders{device_json.parent_path()};
  for (const std::string& name : {device.name, device.device_driver}) {
    if (const auto file = gateway::find_device_json(name, device_tree); file) folders.push_back(file->parent_path());
  }
  folders.push_back(device_tree / "modules");
  const auto kinematics = gateway::ModuleLoader(folders).load<Kinematics>(device.kinematics);
  if (!kinematics) return tl::unexpected(kinematics.error());
  std::vector<std::string> names;
  std::vector<std::pair<double, double>> limits;
  for (const sdk::Joint& joint : device.joints) {
    names.push_back(joint.limits.name);
    limits.emplace_back(ends_below(joint.limits) ? joint.limits.min : -kEndless,
                        ends_above(joint.limits) ? joint.limits.max : kEndless);
  }
  return gateway::LinkChain::make(*kinematics->object, database.bodies.chain, names, limits);
}

}  // namespace

Result<std::unique_ptr<CollisionWatch>> CollisionWatch::open(const std::string& machine, const fs::path& device_tree,
                                                             const fs::path& setup_file) {
  const auto setup = gateway::read_setup(setup_file);
  if (!setup) return fail(setup.error().message);
  const auto device_json = gateway::find_device_json(machine, device_tree);
  if (!device_json) return fail(device_json.error().message);
  const auto database = gateway::read_device_json(*device_json);
  if (!database) return fail(database.error().message);
  if (database->device.name != setup->machine) {
    return fail(fmt::format("{}: /Machine is \"{}\", and the program is simulated on {}", setup_file.string(),
                            setup->machine, database->device.name));
  }
  if (database->bodies.bodies.empty()) {
    return fail(fmt::format("{}: has no Geometry, so that collisions cannot be checked", device_json->string()));
  }
  auto chain = chain_of(*database, *device_json, device_tree);
  if (!chain) return fail(fmt::format("{}: {}", device_json->string(), chain.error().message));
  auto bodies = gateway::scene_bodies(database->bodies, *setup);
  if (!bodies) return fail(fmt::format("{}: {}", setup_file.string(), bodies.error().message));
  return std::unique_ptr<CollisionWatch>(
      new CollisionWatch(setup->machine, setup->part_frame,
                         std::make_unique<gateway::CollisionChecker>(std::move(*chain), std::move(*bodies),
                                                                     setup->part_frame, setup->clearance_mm)));
}

bool CollisionWatch::may_cut(const Move& move) noexcept {
  return !std::holds_alternative<PathTargetGeometry>(move.geometry) &&
         !std::holds_alternative<JointTargetGeometry>(move.geometry);
}

void CollisionWatch::move_done() {
  if (!cutting_.empty()) cutting_.pop_front();
  begun_ = true;
}

void CollisionWatch::take_tool(gateway::Controller& controller) {
  const int number = controller.tools().tools_now().mounted.value_or(gateway::kNoTool);
  gateway::Tool tool{.number = gateway::kNoTool};
  if (const auto tools = controller.tools().tools(); tools) {
    for (const gateway::Tool& each : *tools) {
      if (each.number == number) tool = each;
    }
  }
  tool_fault_.clear();
  if (number == gateway::kNoTool) {
    tool_fault_ = "no tool is in the spindle by the tool table: moves without one were checked with the spindle alone";
  } else if (!tool.shape) {
    tool_fault_ = fmt::format(
        "tool {} has no Shape in the tool table: moves with it were checked with the spindle alone", number);
  }
  checker_->set_tool(tool);
}

void CollisionWatch::cycle(const gateway::CycleSample& sample, int line, gateway::Controller& controller) {
  const sdk::DeviceObject* const device = controller.mechanism();
  if (device == nullptr || device->name != machine_) {
    if (device != nullptr && sample.moving) {
      not_checked_.insert(fmt::format("moves of {}: the set-up is for {}", device->name, machine_));
    }
    return;
  }
  if (std::exchange(look_at_tool_, false)) take_tool(controller);
  if (sample.moving && !tool_fault_.empty()) not_checked_.insert(tool_fault_);
  const bool cutting = sample.moving && !cutting_.empty() && cutting_.front();
  // A simulation begins with all joints at 0, where the machine need not stand: the way from there to the first
  // position is nobody's.
  if (!begun_ && !cutting) return;
  begun_ = true;
  checker_->advance(sample.t_s, std::span(sample.position_set).first(sample.joint_count),
                    {.id = sample.move_id, .line = line, .cutting = cutting});
}

nlohmann::json to_json(const std::vector<gateway::Finding>& findings, bool near) {
  nlohmann::json list = nlohmann::json::array();
  for (const gateway::Finding& f : findings) {
    if (f.collision == near) continue;
    nlohmann::json entry{
        {"line", f.line},       {"move_id", f.move_id},          {"t_s", f.t_s},
        {"until_s", f.until_s}, {"bodies", {f.first, f.second}}, {"place_mm", {f.place[0], f.place[1], f.place[2]}}};
    if (near) {
      entry["distance_mm"] = f.distance_mm;
    } else {
      entry["depth_mm"] = f.depth_mm;
      entry["certain"] = !f.possible;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace rmac::cli
