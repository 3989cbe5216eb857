#include "gateway/rmac/commands/machines/driver_records.hpp"

#include <fmt/format.h>

#include <array>

#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

constexpr std::array kColumns{
    Column{"Machine_GetMechanismID", "MechanismID", "mechanism id", ""},
    Column{"Machine_GetMechanismName", "Name", "name", ""},
    Column{"Machine_GetMechanismDeviceDriver", "DeviceDriver", "device driver", ""},
    Column{"Machine_GetMechanismDeviceDriverVersion", "DriverVersion", "driver version", ""},
    Column{"Machine_GetMechanismType", "Type", "type", ""},
    Column{"Machine_GetMechanismConfigurationType", "ConfigurationType", "configuration", ""},
    Column{"Machine_GetMechanismNumberOfJoints", "NumberOfJoints", "joints", ""},
    Column{"Machine_GetMechanismWorkingVolume", "WorkingVolume", "working volume", "mm"},
    Column{"Machine_GetMechanismSpindleHorsePower", "SpindleHorsePower", "spindle power", "hp"},
    Column{"Machine_GetMechanismSpindleMaxSpeed", "SpindleMaxSpeed", "spindle speed", "rpm"},
    Column{"Machine_GetMechanismSpindleMaxTorque", "SpindleMaxTorque", "spindle torque", "N·m"},
    Column{"Machine_GetMechanismMaxFeedrate", "MaxFeedrate", "feed", "mm/min"},
    Column{"Machine_GetMechanismMaxPalletLoad", "MaxPalletLoad", "pallet load", "kg"},
    Column{"Machine_GetMechanismPositioningTolerance", "PositioningTolerance", "positioning tolerance", "mm"},
    Column{"Machine_GetMechanismRepeatabilityTolerance", "RepeatabilityTolerance", "repeatability", "mm"}};

/// 10203 is 1.2.3: the API has an integer where the data have a text.
std::string version_text(const nlohmann::json& value) {
  if (!value.is_number_integer()) {
    return text_of(value);
  }
  const auto version = value.get<int>();
  return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

}  // namespace

std::span<const Column> columns() {
  return kColumns;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char letter : text) {
    result += letter;
    if (letter == '\'') {
      result += letter;
    }
  }
  return result + "'";
}

std::string text_of(const nlohmann::json& value) {
  if (value.is_string()) {
    return value.get<std::string>();
  }
  return value.is_number_float() ? number(value.get<double>(), 6) : value.dump();
}

Result<nlohmann::json> ask(Connection& connection, const std::string& interface, std::span<const Column> columns,
                           const nlohmann::json& params) {
  nlohmann::json row = nlohmann::json::object();
  std::optional<Failure> failure;
  std::size_t open = 0;
  for (const auto& column : columns) {
    ++open;
    connection.send(interface + "." + column.function, params, [&, key = column.key](const Connection::Answer& answer) {
      --open;
      if (answer) {
        row[key] = *answer;
      } else if (!failure) {
        failure = answer.error();
      }
    });
  }
  if (auto waited = connection.wait([&] { return open == 0; }); !waited) {
    return tl::unexpected(waited.error());
  }
  return failure ? Result<nlohmann::json>(tl::unexpected(*failure)) : row;
}

Result<nlohmann::json> select(Connection& connection, const std::string& sql) {
  auto opened = connection.command("DeviceDriverManager.OpenDeviceDriverDatabase");
  if (!opened) return tl::unexpected(opened.error());
  auto found = connection.call("DeviceDriverManager.SearchDatabaseRecordSet", {{"MachineSQLStatement", sql}});
  if (!found) {
    return tl::unexpected(found.error());
  }
  nlohmann::json rows = nlohmann::json::array();
  const auto count = found->get<int>();
  for (int record = 0; record < count; ++record) {
    if (record > 0) {
      if (auto next = connection.command("DeviceDriverManager.OnNextRecord"); !next) {
        return tl::unexpected(next.error());
      }
    }
    auto row = ask(connection, "DeviceDriverManager", columns(), nlohmann::json::object());
    if (!row) {
      return row;
    }
    (*row)["DriverVersion"] = version_text((*row)["DriverVersion"]);
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace rmac::cli
