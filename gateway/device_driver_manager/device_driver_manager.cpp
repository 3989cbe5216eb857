#include "gateway/device_driver_manager/device_driver_manager.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/device_driver_manager/driver_search.hpp"
#include "gateway/device_driver_manager/driver_table.hpp"

namespace rmac::gateway {
namespace {

DriverRecord record_of(const sdk::DeviceObject& device) {
  DriverRecord record;
  record.name = device.name;
  record.device_driver = device.device_driver;
  record.type = device.type;
  record.configuration_type = device.configuration_type;
  record.number_of_joints = static_cast<int>(device.joints.size());
  record.length = device.length_mm;
  record.width = device.width_mm;
  record.depth = device.depth_mm;
  if (!device.spindles.empty()) {
    record.spindle_horse_power = device.spindles.front().horse_power;
    record.spindle_max_speed = device.spindles.front().max_speed_rpm;
    record.spindle_max_torque = device.spindles.front().max_torque_nm;
  }
  record.max_feedrate = device.max_feedrate_mm_min;
  record.max_pallet_load = device.max_pallet_load_kg;
  record.positioning_tolerance = device.positioning_tolerance_mm;
  record.repeatability_tolerance = device.repeatability_tolerance_mm;
  record.speed_capability = device.speed_capability;
  record.driver_version = device.driver_version;
  return record;
}

/// Gives each mechanism its number: the one its name had, else the one its file claims, else the next free one.
class Numbering {
 public:
  explicit Numbering(const std::map<std::string, std::int64_t>& known) : known_(known) {
    for (const auto& [name, number] : known) take(name, number);
  }

  /// An error when the file claims a number that is another's, or differs from the one that clients know.
  Expected<> claim(const DeviceTree::Mechanism& mechanism) {
    if (!mechanism.database.mechanism_id) return {};
    const std::string& name = mechanism.database.device.name;
    const std::int64_t wanted = *mechanism.database.mechanism_id;
    const auto owner = owners_.find(wanted);
    if (owner != owners_.end() && owner->second != name) {
      return refuse(mechanism, fmt::format("a number of its own; {} has this one", owner->second));
    }
    if (const auto known = known_.find(name); known != known_.end() && known->second != wanted) {
      return refuse(mechanism, fmt::format("{}, the number that {} has had so far", known->second, name));
    }
    take(name, wanted);
    return {};
  }

  std::int64_t number_of(const std::string& name) {
    if (!numbers_.contains(name)) take(name, owners_.empty() ? 1 : owners_.rbegin()->first + 1);
    return numbers_.at(name);
  }

 private:
  void take(const std::string& name, std::int64_t number) {
    owners_[number] = name;
    numbers_[name] = number;
  }
  static tl::unexpected<Error> refuse(const DeviceTree::Mechanism& mechanism, const std::string& allowed) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: /MechanismID is {}; allowed is {}", (mechanism.folder / "device.json").string(),
                               *mechanism.database.mechanism_id, allowed));
  }

  const std::map<std::string, std::int64_t>& known_;
  std::map<std::int64_t, std::string> owners_;
  std::map<std::string, std::int64_t> numbers_;
};

}  // namespace

struct DeviceDriverManager::Impl {
  Options options;
  std::unique_ptr<DriverTable> table;
  std::mutex mutex;  ///< of what the last scan found
  std::vector<ScanProblem> problems;
  std::map<std::string, std::filesystem::path> folders;

  /// Rows for the mechanisms that get a number; takes the others out of the tree, into its problems.
  static std::vector<DriverRecord> numbered(DeviceTree& tree, const std::map<std::string, std::int64_t>& known) {
    Numbering numbering(known);
    // Claims first: a mechanism without one must not take a number that a later folder claims.
    std::erase_if(tree.mechanisms, [&](const DeviceTree::Mechanism& mechanism) {
      const Expected<> claimed = numbering.claim(mechanism);
      if (!claimed) tree.problems.push_back({mechanism.folder / "device.json", claimed.error().message});
      return !claimed;
    });
    std::vector<DriverRecord> records;
    for (const DeviceTree::Mechanism& mechanism : tree.mechanisms) {
      DriverRecord record = record_of(mechanism.database.device);
      record.mechanism_id = numbering.number_of(record.name);
      records.push_back(std::move(record));
    }
    std::sort(records.begin(), records.end(),
              [](const DriverRecord& a, const DriverRecord& b) { return a.mechanism_id < b.mechanism_id; });
    return records;
  }
};

DeviceDriverManager::DeviceDriverManager() : impl_(std::make_unique<Impl>()) {}
DeviceDriverManager::~DeviceDriverManager() = default;

Expected<std::unique_ptr<DeviceDriverManager>> DeviceDriverManager::open(const Options& options) {
  if (const auto scheme = options.database.find("://"); scheme != std::string::npos) {
    return failure(MinorCode::UnsupportedOperation,
                   fmt::format("database: a {} connection is not supported yet; give the path of an SQLite file",
                               options.database.substr(0, scheme)));
  }
  std::unique_ptr<DeviceDriverManager> manager(new DeviceDriverManager);
  manager->impl_->options = options;
  Expected<std::unique_ptr<DriverTable>> table = DriverTable::open(options.database);
  if (!table) return tl::make_unexpected(table.error());
  manager->impl_->table = std::move(*table);
  if (const Expected<int> scanned = manager->rescan(); !scanned) return tl::make_unexpected(scanned.error());
  return manager;
}

Expected<int> DeviceDriverManager::rescan() {
  Expected<DeviceTree> tree = scan_device_tree(impl_->options.device_tree);
  if (!tree) return tl::make_unexpected(tree.error());
  const auto known = impl_->table->numbers();
  if (!known) return tl::make_unexpected(known.error());
  const std::vector<DriverRecord> records = Impl::numbered(*tree, *known);
  if (const Expected<> replaced = impl_->table->replace(records); !replaced) {
    return tl::make_unexpected(replaced.error());
  }
  for (const ScanProblem& problem : tree->problems) {
    spdlog::warn("left out of the device driver database: {}", problem.message);
  }
  const std::lock_guard hold(impl_->mutex);
  impl_->problems = std::move(tree->problems);
  impl_->folders.clear();
  for (const DeviceTree::Mechanism& mechanism : tree->mechanisms) {
    impl_->folders[mechanism.database.device.name] = mechanism.folder;
  }
  return static_cast<int>(records.size());
}

const std::vector<DeviceDriverManager::ScanProblem>& DeviceDriverManager::problems() const noexcept {
  return impl_->problems;
}

Expected<std::vector<DriverRecord>> DeviceDriverManager::all() const {
  return impl_->table->all();
}

Expected<std::vector<DriverRecord>> DeviceDriverManager::search(const std::string& sql) const {
  const Expected<std::vector<std::int64_t>> numbers = search_mechanisms(impl_->options, sql);
  if (!numbers) return tl::make_unexpected(numbers.error());
  const Expected<std::vector<DriverRecord>> records = all();
  if (!records) return tl::make_unexpected(records.error());
  std::map<std::int64_t, const DriverRecord*> by_number;
  for (const DriverRecord& record : *records) by_number[record.mechanism_id] = &record;

  std::vector<DriverRecord> found;
  for (const std::int64_t number : *numbers) {
    const auto record = by_number.find(number);
    if (record == by_number.end()) {
      return failure(
          MinorCode::InvalidParameterValue,
          fmt::format("the SQL statement was refused: it gives {} as a MechanismID, which no mechanism has", number));
    }
    found.push_back(*record->second);
  }
  return found;
}

Expected<std::filesystem::path> DeviceDriverManager::folder_of(const std::string& mechanism) const {
  const std::lock_guard hold(impl_->mutex);
  if (const auto folder = impl_->folders.find(mechanism); folder != impl_->folders.end()) return folder->second;
  for (const ScanProblem& problem : problems()) {
    if (problem.file.parent_path().filename() == mechanism) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("mechanism \"{}\" is left out of the device tree: {}", mechanism, problem.message));
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, unused] : impl_->folders) names.push_back(name);
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("there is no mechanism \"{}\" in {}; there are: {}", mechanism,
                             impl_->options.device_tree.string(), fmt::join(names, ", ")));
}

}  // namespace rmac::gateway
