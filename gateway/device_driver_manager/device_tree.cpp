#include "gateway/device_driver_manager/device_tree.hpp"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <map>
#include <string>
#include <system_error>

namespace rmac::gateway {
namespace {

using Folders = std::vector<std::filesystem::path>;

/// The folders in a folder, sorted, so that every scan goes the same way.
Folders subfolders(const std::filesystem::path& folder, std::error_code& code) {
  Folders found;
  for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The three names of the folder and of its device.json must agree, or a driver would be found under a wrong name.
std::string misplaced(const std::filesystem::path& folder, const sdk::DeviceObject& device) {
  const std::string mechanism = folder.filename().string();
  const std::string configuration = folder.parent_path().filename().string();
  const std::string type = folder.parent_path().parent_path().filename().string();
  const auto differs = [](const char* key, const std::string& value, const std::string& wanted) {
    return fmt::format("/{} is \"{}\"; allowed is \"{}\", the name of the folder it lies in", key, value, wanted);
  };
  if (device.name != mechanism) return differs("MechanismName", device.name, mechanism);
  if (device.configuration_type != configuration) {
    return differs("ConfigurationType", device.configuration_type, configuration);
  }
  if (strcasecmp(device.type.c_str(), type.c_str()) != 0) return differs("Type", device.type, type);
  return {};
}

class Scan {
 public:
  explicit Scan(const std::filesystem::path& root) : root_(std::filesystem::weakly_canonical(root)) {}

  void read(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "device.json";
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return;
    if (const auto place = std::filesystem::canonical(file, code); code || !is_in_tree(place)) {
      return report(file,
                    fmt::format("{}: a link leads out of the device tree, to {}; put the mechanism's folder itself "
                                "into the tree",
                                file.string(), place.string()));
    }
    Expected<DeviceDatabase> database = read_device_json(file);
    if (!database) return report(file, database.error().message);
    if (const std::string problem = misplaced(folder, database->device); !problem.empty()) {
      return report(file, fmt::format("{}: {}", file.string(), problem));
    }
    const auto [first, is_new] = folders_.emplace(database->device.name, folder);
    if (!is_new) {
      return report(file,
                    fmt::format("{}: /MechanismName is \"{}\", which {} has already; allowed is a name of its own",
                                file.string(), database->device.name, first->second.string()));
    }
    tree_.mechanisms.push_back({folder, std::move(*database)});
  }

  void report(const std::filesystem::path& file, std::string message) {
    tree_.problems.push_back({file, std::move(message)});
  }

  DeviceTree result() && { return std::move(tree_); }

 private:
  [[nodiscard]] bool is_in_tree(const std::filesystem::path& place) const {
    return std::mismatch(root_.begin(), root_.end(), place.begin(), place.end()).first == root_.end();
  }

  std::filesystem::path root_;  ///< without links
  DeviceTree tree_;
  std::map<std::string, std::filesystem::path> folders_;
};

}  // namespace

Expected<DeviceTree> scan_device_tree(const std::filesystem::path& root) {
  constexpr int kLevels = 3;  // type, configuration, mechanism
  Scan scan(root);
  Folders level{root};
  for (int depth = 0; depth < kLevels; ++depth) {
    Folders next;
    for (const std::filesystem::path& folder : level) {
      std::error_code code;
      Folders found = subfolders(folder, code);
      if (code && depth == 0) {
        return failure(
            MinorCode::InvalidParameterValue,
            fmt::format("the device tree {} cannot be read: {}; set device_tree in rmacd.json to the folder that "
                        "holds <type>/<configuration>/<Mechanism>/device.json",
                        root.string(), code.message()));
      }
      if (code) scan.report(folder, fmt::format("{}: the folder cannot be read: {}", folder.string(), code.message()));
      std::move(found.begin(), found.end(), std::back_inserter(next));
    }
    level = std::move(next);
  }
  for (const std::filesystem::path& folder : level) scan.read(folder);
  return std::move(scan).result();
}

bool is_path_of_machine(const std::string& machine) {
  return machine.find('/') != std::string::npos || machine.ends_with(".json") || machine == ".";
}

Expected<std::filesystem::path> find_device_json(const std::string& machine, const std::filesystem::path& root) {
  constexpr const char* kFile = "device.json";
  if (is_path_of_machine(machine)) {
    const std::filesystem::path path = std::filesystem::absolute(machine).lexically_normal();
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored) ? path / kFile : path;
  }
  const auto tree = scan_device_tree(root);
  if (!tree) return tl::unexpected(tree.error());
  std::vector<std::string> names;
  for (const DeviceTree::Mechanism& found : tree->mechanisms) {
    if (found.database.device.name == machine) return found.folder / kFile;
    names.push_back(found.database.device.name);
  }
  for (const DeviceDriverManager::ScanProblem& problem : tree->problems) {
    if (problem.file.parent_path().filename() == machine) return problem.file;  // whoever reads it says what is wrong
  }
  return failure(MinorCode::InvalidParameterValue, fmt::format("there is no machine \"{}\" in {}; there are: {}",
                                                               machine, root.string(), fmt::join(names, ", ")));
}

}  // namespace rmac::gateway
