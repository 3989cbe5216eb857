// DeviceDriverManager.*: Appendix II of the dissertation.
#include <charconv>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using Done = Expected<>;

/// "1.2.3" as the integer 10203 that the API gives.
Expected<std::int64_t> version_number(const std::string& version) {
  std::int64_t number = 0;
  const char* at = version.data();
  const char* const end = at + version.size();
  for (int part = 0; part < 3; ++part) {
    int value = 0;
    const auto [next, problem] = std::from_chars(at, end, value);
    const bool separated = part == 2 ? next == end : next != end && *next == '.';
    if (problem != std::errc{} || value < 0 || value > 99 || !separated) {
      return failure(MinorCode::Other, fmt::format("the driver version \"{}\" is not of the form 1.2.3", version));
    }
    number = number * 100 + value;
    at = next + 1;
  }
  return number;
}

/// A getter of one column of the row under the cursor.
template <typename Function>
Method column(const char* name, const char* meaning, WireType type, const char* unit, Function function) {
  return method(name, meaning).gives(type, unit).does([function](Call& call) {
    return call.session.records().current().map(function);
  });
}

}  // namespace

void add_driver_manager_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method("DeviceDriverManager.OpenDeviceDriverDatabase",
             "Opens this connection's record set with every mechanism in it, the first one current.")
          .gives(WireType::Boolean)
          .does([](Call& call) { return call.session.records().open(); }));
  add(method("DeviceDriverManager.CloseDeviceDriverDatabase", "Closes this connection's record set.")
          .gives(WireType::Boolean)
          .does([](Call& call) {
            call.session.records().close();
            return Done{};
          }));
  add(method("DeviceDriverManager.GetTotalNumberOfRecords", "Number of mechanisms in the device driver database.")
          .gives(WireType::Integer)
          .does([](Call& call) { return call.session.records().total(); }));
  add(method("DeviceDriverManager.SearchDatabaseRecordSet",
             "Replaces the record set by the mechanisms that a SELECT on the table DeviceDrivers finds; gives their "
             "number.")
          .takes(
              text("MachineSQLStatement").noted("one read-only SELECT that yields MechanismID (or *), within 200 ms"))
          .gives(WireType::Integer)
          .runs_apart()
          .does([](Call& call, const std::string& sql) { return call.session.records().search(sql); }));
  add(method("DeviceDriverManager.GetDatabaseRecordSetColumns",
             "Checks that the record set has a current row; the getters below read it.")
          .gives(WireType::Boolean)
          .does([](Call& call) {
            return call.session.records().current().map([](const DriverRecord&) { return true; });
          }));
  add(method("DeviceDriverManager.OnNextRecord", "Goes to the next row; on the last one an error.")
          .does([](Call& call) { return call.session.records().next(); }));
  add(method("DeviceDriverManager.OnPreviousRecord", "Goes to the row before; on the first one an error.")
          .does([](Call& call) { return call.session.records().previous(); }));
  add(method("DeviceDriverManager.OnFirstRecord", "Goes to the first row.").does([](Call& call) {
    return call.session.records().first();
  }));
  add(method("DeviceDriverManager.OnLastRecord", "Goes to the last row.").does([](Call& call) {
    return call.session.records().last();
  }));

  using R = DriverRecord;
  add(column("DeviceDriverManager.Machine_GetMechanismID", "Number of the mechanism in the database.",
             WireType::Integer, "", [](const R& row) { return row.mechanism_id; }));
  add(column("DeviceDriverManager.Machine_GetMechanismName", "Name of the mechanism.", WireType::String, "",
             [](const R& row) { return row.name; }));
  add(column("DeviceDriverManager.Machine_GetMechanismDeviceDriver", "Name of its device driver.", WireType::String, "",
             [](const R& row) { return row.device_driver; }));
  add(method("DeviceDriverManager.Machine_GetMechanismDeviceDriverVersion",
             "Version of its device driver, 1.2.3 as 10203.")
          .gives(WireType::Integer)
          .does([](Call& call) {
            return call.session.records().current().and_then(
                [](const R& row) { return version_number(row.driver_version); });
          }));
  add(column("DeviceDriverManager.Machine_GetMechanismType", "What kind of machine it is, e.g. Mill.", WireType::String,
             "", [](const R& row) { return row.type; }));
  add(column("DeviceDriverManager.Machine_GetMechanismConfigurationType", "Its arrangement, e.g. 3-axis.",
             WireType::String, "", [](const R& row) { return row.configuration_type; }));
  add(column("DeviceDriverManager.Machine_GetMechanismNumberOfJoints", "Number of joints it moves.", WireType::Integer,
             "", [](const R& row) { return row.number_of_joints; }));
  add(column("DeviceDriverManager.Machine_GetMechanismWorkingVolume",
             "Length, width and depth of the working volume, as \"100x100x100\".", WireType::String, "mm",
             [](const R& row) { return fmt::format("{}x{}x{}", row.length, row.width, row.depth); }));
  add(column("DeviceDriverManager.Machine_GetMechanismSpindleHorsePower", "Power of its spindle.", WireType::Number,
             "hp", [](const R& row) { return row.spindle_horse_power; }));
  add(column("DeviceDriverManager.Machine_GetMechanismSpindleMaxSpeed", "Largest speed of its spindle.",
             WireType::Number, "rpm", [](const R& row) { return row.spindle_max_speed; }));
  add(column("DeviceDriverManager.Machine_GetMechanismSpindleMaxTorque", "Largest torque of its spindle.",
             WireType::Number, "N·m", [](const R& row) { return row.spindle_max_torque; }));
  add(column("DeviceDriverManager.Machine_GetMechanismMaxFeedrate", "Largest feed.", WireType::Number, "mm/min",
             [](const R& row) { return row.max_feedrate; }));
  add(column("DeviceDriverManager.Machine_GetMechanismMaxPalletLoad", "Largest load on its table.", WireType::Number,
             "kg", [](const R& row) { return row.max_pallet_load; }));
  add(column("DeviceDriverManager.Machine_GetMechanismPositioningTolerance", "How exactly it reaches a position.",
             WireType::Number, "mm", [](const R& row) { return row.positioning_tolerance; }));
  add(column("DeviceDriverManager.Machine_GetMechanismRepeatabilityTolerance", "How exactly it reaches it again.",
             WireType::Number, "mm", [](const R& row) { return row.repeatability_tolerance; }));
  add(method("DeviceDriverManager.Rescan",
             "Reads the device tree again. Gives `mechanisms`, how many are in the database after it, and `problems`, "
             "what was left out: `file` and `message` of each.")
          .gives(WireType::Object)
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call) {
            return call.machine.rescan().map([](const ScanReport& report) {
              nlohmann::json problems = nlohmann::json::array();
              for (const auto& [file, message] : report.problems) {
                problems.push_back({{"file", file.string()}, {"message", message}});
              }
              return nlohmann::json{{"mechanisms", report.mechanisms}, {"problems", problems}};
            });
          }));
}

}  // namespace rmac::gateway
