#include "gateway/simulation/simulation.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "gateway/appliance/machine.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/processes/temporary_folder.hpp"
#include "gateway/simulation/only_client.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

ControllerOptions controller_options(const Simulation::Options& options, const std::vector<fs::path>& folders) {
  ControllerOptions made;
  for (const fs::path& folder : folders) made.module_folders.push_back(folder.string());
  made.module_folders.push_back((options.device_tree / "modules").string());
  made.period_s = options.period_s;
  made.tools_folder = options.tools_folder;
  made.stepped = true;
  made.queue_capacity = options.queue_capacity;
  return made;
}

/// Where the device tree has modules for a device.json that lies elsewhere.
std::vector<fs::path> folders_for(const sdk::DeviceObject& device, const DeviceDriverManager& manager) {
  std::vector<fs::path> folders;
  for (const std::string& name : {device.name, device.device_driver}) {
    if (auto folder = manager.folder_of(name)) folders.push_back(std::move(*folder));
  }
  return folders;
}

}  // namespace

/// In the order in which they need each other.
struct Simulation::Parts {
  Parts(const Options& options, std::unique_ptr<TemporaryFolder> database_folder,
        std::unique_ptr<DeviceDriverManager> device_drivers, const std::vector<fs::path>& module_folders)
      : folder(std::move(database_folder)),
        manager(std::move(device_drivers)),
        controller(controller_options(options, module_folders)),
        host(*manager, controller),
        machine(controller, host, *manager),
        dispatcher(machine),
        client(*manager, {{"server", "rmac simulate"}, {"version", RMAC_VERSION}}) {}

  std::unique_ptr<TemporaryFolder> folder;
  std::unique_ptr<DeviceDriverManager> manager;
  Controller controller;
  DeviceHost host;
  Machine machine;
  Dispatcher dispatcher;
  OnlyClient client;
};

Simulation::Simulation(const Options& options) : options_(options) {}
Simulation::~Simulation() = default;

Expected<std::unique_ptr<Simulation>> Simulation::open(const Options& options, const std::string& machine) {
  std::unique_ptr<Simulation> simulation(new Simulation(options));
  auto folder = std::make_unique<TemporaryFolder>("simulation");
  if (folder->path().empty()) {
    return failure(MinorCode::Other,
                   fmt::format("no folder for the device driver database can be made in {}: {}",
                               fs::temp_directory_path().string(), std::generic_category().message(errno)));
  }
  auto manager = DeviceDriverManager::open({.device_tree = options.device_tree,
                                            .database = (folder->path() / "drivers.sqlite").string(),
                                            .searcher = options.searcher});
  if (!manager) return tl::unexpected(manager.error());
  std::vector<fs::path> module_folders;
  Expected<fs::path> file;
  if (is_path_of_machine(machine)) {
    file = find_device_json(machine, options.device_tree);
    const auto device = read_device_database(*file);
    if (!device) return tl::unexpected(device.error());
    module_folders = folders_for(*device, **manager);
  }
  simulation->parts_ = std::make_unique<Parts>(options, std::move(folder), std::move(*manager), module_folders);
  Parts& parts = *simulation->parts_;
  auto ready = parts.controller.start();
  if (ready && !file->empty()) {
    ready = parts.host.load_file(*file, true);
  } else if (ready && !machine.empty()) {
    ready = parts.host.load(machine, true);
  }
  if (!ready) return tl::unexpected(ready.error());
  return simulation;
}

Answer Simulation::call(const std::string& method, nlohmann::json params) {
  nlohmann::json message{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}};
  if (!params.is_null()) message["params"] = std::move(params);
  return parts_->dispatcher.execute(read_request(std::move(message)), parts_->client);
}

void Simulation::cycle() {
  parts_->controller.cycle();
}

Controller& Simulation::controller() noexcept {
  return parts_->controller;
}

}  // namespace rmac::gateway
