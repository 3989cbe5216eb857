#include "gateway/device_driver_manager/driver_table.hpp"

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <filesystem>
#include <mutex>
#include <system_error>

namespace rmac::gateway {
namespace {

constexpr int kLayout = 1;  ///< of the tables below; kept in the file as user_version

constexpr const char* kMakeDrivers =
    "CREATE TABLE DeviceDrivers ("
    "MechanismID INTEGER PRIMARY KEY, Name TEXT NOT NULL UNIQUE, DeviceDriver TEXT NOT NULL, Type TEXT NOT NULL, "
    "ConfigurationType TEXT NOT NULL, NumberOfJoints INTEGER NOT NULL, Length REAL NOT NULL, Width REAL NOT NULL, "
    "Depth REAL NOT NULL, SpindleHorsePower REAL NOT NULL, SpindleMaxSpeed REAL NOT NULL, "
    "SpindleMaxTorque REAL NOT NULL, MaxFeedrate REAL NOT NULL, MaxPalletLoad REAL NOT NULL, "
    "PositioningTolerance REAL NOT NULL, RepeatabilityTolerance REAL NOT NULL, SpeedCapability TEXT NOT NULL, "
    "DriverVersion TEXT NOT NULL)";
constexpr const char* kMakeNumbers =
    "CREATE TABLE MechanismNumbers (Name TEXT PRIMARY KEY, MechanismID INTEGER NOT NULL UNIQUE)";

constexpr const char* kInsert =
    "INSERT INTO DeviceDrivers (MechanismID, Name, DeviceDriver, Type, ConfigurationType, NumberOfJoints, Length, "
    "Width, "
    "Depth, SpindleHorsePower, SpindleMaxSpeed, SpindleMaxTorque, MaxFeedrate, MaxPalletLoad, PositioningTolerance, "
    "RepeatabilityTolerance, SpeedCapability, DriverVersion) VALUES (:id, :name, :driver, :type, :configuration, "
    ":joints, "
    ":length, :width, :depth, :horse_power, :max_speed, :max_torque, :feedrate, :load, :positioning, :repeatability, "
    ":capability, :version)";
constexpr const char* kSelect =
    "SELECT MechanismID, Name, DeviceDriver, Type, ConfigurationType, NumberOfJoints, Length, Width, Depth, "
    "SpindleHorsePower, SpindleMaxSpeed, SpindleMaxTorque, MaxFeedrate, MaxPalletLoad, PositioningTolerance, "
    "RepeatabilityTolerance, SpeedCapability, DriverVersion FROM DeviceDrivers ORDER BY MechanismID";

DriverRecord record_from(const soci::row& row) {
  DriverRecord record;
  // SOCI goes by the declared type: INTEGER PRIMARY KEY comes as int or as long long, depending on its version.
  record.mechanism_id =
      row.get_properties(0).get_data_type() == soci::dt_long_long ? row.get<long long>(0) : row.get<int>(0);
  row.skip();
  row >> record.name >> record.device_driver >> record.type >> record.configuration_type >> record.number_of_joints >>
      record.length >> record.width >> record.depth >> record.spindle_horse_power >> record.spindle_max_speed >>
      record.spindle_max_torque >> record.max_feedrate >> record.max_pallet_load >> record.positioning_tolerance >>
      record.repeatability_tolerance >> record.speed_capability >> record.driver_version;
  return record;
}

}  // namespace

struct DriverTable::Impl {
  std::string file;
  std::mutex mutex;  ///< of the session: searches come from a thread of their own
  soci::session session;

  void prepare() {
    int layout = 0;
    session << "PRAGMA user_version", soci::into(layout);
    if (layout == kLayout) return;
    if (layout != 0) throw std::runtime_error(fmt::format("its layout is {}, this daemon knows {}", layout, kLayout));
    soci::transaction transaction(session);
    session << kMakeDrivers;
    session << kMakeNumbers;
    session << fmt::format("PRAGMA user_version = {}", kLayout);
    transaction.commit();
  }

  [[nodiscard]] std::vector<DriverRecord> rows() {
    std::vector<DriverRecord> records;
    const soci::rowset<soci::row> found = session.prepare << kSelect;
    for (const soci::row& row : found) records.push_back(record_from(row));
    return records;
  }

  void insert(const DriverRecord& record) {
    const long long id = record.mechanism_id;
    session << kInsert, soci::use(id), soci::use(record.name), soci::use(record.device_driver), soci::use(record.type),
        soci::use(record.configuration_type), soci::use(record.number_of_joints), soci::use(record.length),
        soci::use(record.width), soci::use(record.depth), soci::use(record.spindle_horse_power),
        soci::use(record.spindle_max_speed), soci::use(record.spindle_max_torque), soci::use(record.max_feedrate),
        soci::use(record.max_pallet_load), soci::use(record.positioning_tolerance),
        soci::use(record.repeatability_tolerance), soci::use(record.speed_capability), soci::use(record.driver_version);
    session << "INSERT OR REPLACE INTO MechanismNumbers (Name, MechanismID) VALUES (:name, :id)",
        soci::use(record.name), soci::use(id);
  }

  [[nodiscard]] tl::unexpected<Error> failed(const std::exception& error) const {
    return failure(MinorCode::Other,
                   fmt::format("device driver database {}: {}. Check that the folder can be written; the file may be "
                               "deleted while the daemon is down, a scan fills a new one",
                               file, error.what()));
  }
};

DriverTable::DriverTable() : impl_(std::make_unique<Impl>()) {}
DriverTable::~DriverTable() = default;

Expected<std::unique_ptr<DriverTable>> DriverTable::open(const std::string& file) {
  std::unique_ptr<DriverTable> table(new DriverTable);
  table->impl_->file = file;
  try {
    if (file.find('"') != std::string::npos) throw std::runtime_error("a quotation mark in the path is not supported");
    std::filesystem::create_directories(std::filesystem::absolute(file).parent_path());
    table->impl_->session.open(soci::sqlite3, fmt::format("db=\"{}\" timeout=5", file));
    table->impl_->prepare();
    return table;
  } catch (const std::exception& error) {
    return table->impl_->failed(error);
  }
}

Expected<std::map<std::string, std::int64_t>> DriverTable::numbers() {
  const std::lock_guard hold(impl_->mutex);
  try {
    std::map<std::string, std::int64_t> numbers;
    std::string name;
    long long id = 0;
    soci::statement rows =
        (impl_->session.prepare << "SELECT Name, MechanismID FROM MechanismNumbers", soci::into(name), soci::into(id));
    rows.execute();
    while (rows.fetch()) numbers[name] = id;
    return numbers;
  } catch (const std::exception& error) {
    return impl_->failed(error);
  }
}

Expected<> DriverTable::replace(const std::vector<DriverRecord>& records) {
  const std::lock_guard hold(impl_->mutex);
  try {
    // A scan that finds nothing new shall not wear the appliance's flash.
    if (impl_->rows() == records) return {};
    soci::transaction transaction(impl_->session);
    impl_->session << "DELETE FROM DeviceDrivers";
    for (const DriverRecord& record : records) impl_->insert(record);
    transaction.commit();
    return {};
  } catch (const std::exception& error) {
    return impl_->failed(error);
  }
}

Expected<std::vector<DriverRecord>> DriverTable::all() {
  const std::lock_guard hold(impl_->mutex);
  try {
    return impl_->rows();
  } catch (const std::exception& error) {
    return impl_->failed(error);
  }
}

}  // namespace rmac::gateway
