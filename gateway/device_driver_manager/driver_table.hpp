#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/device_driver_manager/device_driver_manager.hpp"

namespace rmac::gateway {

/// The device driver database on disk: the table DeviceDrivers (Table 4-1), and beside it which number a name was
/// given, so that a mechanism that leaves the tree and comes back is the same one to its clients. Any thread.
class DriverTable {
 public:
  /// Opens the SQLite file, or makes it with its folder.
  [[nodiscard]] static Expected<std::unique_ptr<DriverTable>> open(const std::string& file);
  ~DriverTable();

  /// The numbers given so far, by name.
  [[nodiscard]] Expected<std::map<std::string, std::int64_t>> numbers();
  /// Makes these the rows, all or none of them.
  [[nodiscard]] Expected<> replace(const std::vector<DriverRecord>& records);
  /// In the order of MechanismID.
  [[nodiscard]] Expected<std::vector<DriverRecord>> all();

 private:
  DriverTable();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::gateway
