#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// One row of the device driver database (Table 4-1; the dissertation's device driver object, figure 4.7). Units as in
/// the contract.
struct DriverRecord {
  std::int64_t mechanism_id = 0;
  std::string name, device_driver, type, configuration_type;
  int number_of_joints = 0;
  double length = 0, width = 0, depth = 0;
  double spindle_horse_power = 0, spindle_max_speed = 0, spindle_max_torque = 0;
  double max_feedrate = 0, max_pallet_load = 0, positioning_tolerance = 0, repeatability_tolerance = 0;
  std::string speed_capability;
  std::string driver_version;  ///< "1.2.3"

  bool operator==(const DriverRecord&) const = default;
};

/// Appendix II's record set: the rows of the last search and a cursor on one of them. Each connection has its own.
class DriverRecordSet;

/// The device driver manager (dissertation 4.2): scans the device tree into the device driver database and answers
/// searches. Gateway thread, except for `all`, `search` and `folder_of`, which any thread may call.
class DeviceDriverManager {
 public:
  struct Options {
    std::filesystem::path device_tree;            ///< holds <type>/<configuration>/<Mechanism>/device.json
    std::string database;                         ///< path of the SQLite file, or a "postgresql://…" connection
    std::filesystem::path searcher{};             ///< the program rmac-search; without it nobody may search
    std::chrono::milliseconds search_limit{200};  ///< CPU time that a search may take
  };
  struct ScanProblem {
    std::filesystem::path file;
    std::string message;
  };

  /// Opens (makes) the database and scans the tree. A folder whose device.json is bad is left out and reported by
  /// `problems`.
  [[nodiscard]] static Expected<std::unique_ptr<DeviceDriverManager>> open(const Options& options);
  ~DeviceDriverManager();

  [[nodiscard]] Expected<int> rescan();
  [[nodiscard]] const std::vector<ScanProblem>& problems() const noexcept;
  [[nodiscard]] Expected<std::vector<DriverRecord>> all() const;
  /// Rows that a client's own SQL selects: one statement that reads the DeviceDrivers table alone, bounded in time and
  /// size. Blocks; a program of its own runs it, and is killed at the limit.
  [[nodiscard]] Expected<std::vector<DriverRecord>> search(const std::string& sql) const;
  /// The folder of a mechanism, or an error that lists the names there are.
  [[nodiscard]] Expected<std::filesystem::path> folder_of(const std::string& mechanism) const;

 private:
  DeviceDriverManager();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class DriverRecordSet {
 public:
  explicit DriverRecordSet(const DeviceDriverManager& manager) : manager_(manager) {}
  [[nodiscard]] Expected<> open();  ///< all records, cursor on the first
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return open_; }
  [[nodiscard]] Expected<int> total() const;
  [[nodiscard]] Expected<int> search(const std::string& sql);
  /// The row under the cursor; an error when the set is closed or empty.
  [[nodiscard]] Expected<DriverRecord> current() const;
  [[nodiscard]] Expected<> first();
  [[nodiscard]] Expected<> last();
  [[nodiscard]] Expected<> next();      ///< stays on the last row, with an error
  [[nodiscard]] Expected<> previous();  ///< stays on the first row, with an error

 private:
  const DeviceDriverManager& manager_;
  std::vector<DriverRecord> rows_;
  std::size_t cursor_ = 0;
  bool open_ = false;
};

}  // namespace rmac::gateway
