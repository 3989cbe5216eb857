#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>

#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/fits.hpp"
#include "gateway/rmac/helper_program.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

namespace {

struct Column {
  const char* function;  ///< Appendix II, without the interface
  const char* key;       ///< in JSON, and the database's column where there is one
  const char* title;     ///< in `rmac show`
  const char* unit;
};

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

struct JointColumn {
  const char* function;
  const char* key;
};

constexpr std::array kJointColumns{JointColumn{"Machine_GetMechanismJntTypes", "Type"},
                                   JointColumn{"Machine_GetMechanismJntMinLimit", "Min"},
                                   JointColumn{"Machine_GetMechanismJntMaxLimit", "Max"},
                                   JointColumn{"Machine_GetMechanismJntMaxSpeed", "MaxSpeed"},
                                   JointColumn{"Machine_GetMechanismJntMaxAccel", "MaxAcceleration"},
                                   JointColumn{"Machine_GetMechanismJntMaxJerk", "MaxJerk"},
                                   JointColumn{"Machine_GetMechanismJntServoControlLaw", "ServoControlLaw"}};

std::string text_of(const nlohmann::json& value) {
  if (value.is_string()) {
    return value.get<std::string>();
  }
  return value.is_number_float() ? number(value.get<double>(), 6) : value.dump();
}

/// 10203 is 1.2.3: the API has an integer where the data have a text.
std::string version_text(const nlohmann::json& value) {
  if (!value.is_number_integer()) {
    return text_of(value);
  }
  const auto version = value.get<int>();
  return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
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

Result<std::array<double, 3>> read_volume(const std::string& text) {
  std::array<double, 3> sides{};
  std::string_view rest = text;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), sides[side]);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    const bool last = side + 1 == sides.size();
    if (error != std::errc() || (last ? !rest.empty() : !rest.starts_with('x'))) {
      return fail(fmt::format("--volume {}: write length x width x depth in mm, such as 150x150x150", text));
    }
    rest.remove_prefix(last ? 0 : 1);
  }
  return sides;
}

Result<std::string> sql_of(const MachineSearch& search) {
  if (!search.sql.empty()) {
    return search.sql;
  }
  std::string conditions;
  const auto add = [&](const std::string& condition) {
    conditions += (conditions.empty() ? " WHERE " : " AND ") + condition;
  };
  if (!search.type.empty()) {
    add("lower(Type) = lower(" + quoted(search.type) + ")");
  }
  if (!search.configuration.empty()) {
    add("lower(ConfigurationType) = lower(" + quoted(search.configuration) + ")");
  }
  if (search.joints) {
    add(fmt::format("NumberOfJoints = {}", *search.joints));
  }
  if (!search.volume.empty()) {
    const auto sides = read_volume(search.volume);
    if (!sides) {
      return tl::unexpected(sides.error());
    }
    add(fmt::format("Length >= {} AND Width >= {} AND Depth >= {}", (*sides)[0], (*sides)[1], (*sides)[2]));
  }
  if (search.spindle_hp) {
    add(fmt::format("SpindleHorsePower >= {}", *search.spindle_hp));
  }
  return "SELECT * FROM DeviceDrivers" + conditions + " ORDER BY MechanismID";
}

/// Asks a list of functions in one go and puts the answers under their keys.
template <typename Columns>
Result<nlohmann::json> ask(Connection& connection, const std::string& interface, const Columns& columns,
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
  auto opened = connection.call("DeviceDriverManager.OpenDeviceDriverDatabase");
  if (!opened) {
    return tl::unexpected(opened.error());
  }
  auto found = connection.call("DeviceDriverManager.SearchDatabaseRecordSet", {{"MachineSQLStatement", sql}});
  if (!found) {
    return tl::unexpected(found.error());
  }
  nlohmann::json rows = nlohmann::json::array();
  const auto count = found->get<int>();
  for (int record = 0; record < count; ++record) {
    if (record > 0) {
      if (auto next = connection.call("DeviceDriverManager.OnNextRecord"); !next) {
        return tl::unexpected(next.error());
      }
    }
    auto row = ask(connection, "DeviceDriverManager", kColumns, nlohmann::json::object());
    if (!row) {
      return row;
    }
    (*row)["DriverVersion"] = version_text((*row)["DriverVersion"]);
    rows.push_back(std::move(*row));
  }
  return rows;
}

/// The joints of the loaded mechanism, when it is `name`; null otherwise.
Result<nlohmann::json> joints_if_loaded(Connection& connection, const std::string& name) {
  const auto loaded = connection.call("Device.Machine_GetMechanismName");
  if (!loaded || *loaded != name) {
    return nlohmann::json();
  }
  const auto count = connection.call("Device.Machine_GetMechanismNumberOfJoints");
  if (!count) {
    return tl::unexpected(count.error());
  }
  nlohmann::json joints = nlohmann::json::array();
  for (int joint = 0; joint < count->get<int>(); ++joint) {
    auto row = ask(connection, "Device", kJointColumns, {{"JntNum", joint}});
    if (!row) {
      return row;
    }
    constexpr std::array kTypes{"rotary", "linear", "screw"};
    const auto type = (*row)["Type"].get<std::size_t>();
    (*row)["Type"] = type < kTypes.size() ? kTypes[type] : "unknown";
    joints.push_back(std::move(*row));
  }
  return joints;
}

void print_joints(const nlohmann::json& joints) {
  std::vector<std::string> header{"joint"};
  for (const auto& column : kJointColumns) {
    header.emplace_back(column.key);
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& joint : joints) {
    std::vector<std::string> row{std::to_string(rows.size())};
    for (const auto& column : kJointColumns) {
      row.push_back(text_of(joint.at(column.key)));
    }
    rows.push_back(std::move(row));
  }
  fmt::print("\n{}", table(header, rows));
}

/// Puts under each machine what it makes of the program.
Result<> add_fits(const MachineSearch& search, nlohmann::json& machines) {
  const auto program = read_program(search.program);
  if (!program) {
    return tl::unexpected(program.error());
  }
  for (auto& machine : machines) {
    const Fit fit = fit_of(*program, machine.at("Name").get<std::string>(), search.device_tree, search.tools);
    machine["Fits"] = fit.fits;
    if (fit.fits) {
      machine["CycleTime_s"] = fit.cycle_time_s;
    } else {
      machine["WhyNot"] = fit.why_not;
    }
  }
  return {};
}

void print_fits(const nlohmann::json& machines) {
  std::vector<std::vector<std::string>> cells;
  for (const auto& machine : machines) {
    const bool fits = machine.at("Fits").get<bool>();
    cells.push_back({machine.at("Name").get<std::string>(), text_of(machine.at("NumberOfJoints")),
                     fits ? number(machine.at("CycleTime_s").get<double>()) : "",
                     fits ? "" : machine.at("WhyNot").get<std::string>()});
  }
  fmt::print("{}", table({"name", "joints", "cycle time s", "why not"}, cells));
}

}  // namespace

Result<> list_machines(Connection& connection, const MachineSearch& search, bool json) {
  const auto sql = sql_of(search);
  if (!sql) {
    return tl::unexpected(sql.error());
  }
  auto rows = select(connection, *sql);
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  if (!search.program.empty()) {
    if (auto added = add_fits(search, *rows); !added) {
      return added;
    }
  }
  if (json) {
    fmt::print("{}\n", rows->dump());
    return {};
  }
  if (!search.program.empty()) {
    print_fits(*rows);
    return {};
  }
  constexpr std::array kKeys{
      "Name", "Type", "ConfigurationType", "NumberOfJoints", "WorkingVolume", "SpindleHorsePower", "MaxFeedrate"};
  std::vector<std::vector<std::string>> cells;
  for (const auto& row : *rows) {
    auto& line = cells.emplace_back();
    for (const auto* key : kKeys) {
      line.push_back(text_of(row.at(key)));
    }
  }
  fmt::print("{}", table({"name", "type", "configuration", "joints", "volume mm", "spindle hp", "feed mm/min"}, cells));
  return {};
}

Result<> show_machine(Connection& connection, const std::string& name, bool json) {
  const auto rows = select(connection, "SELECT * FROM DeviceDrivers WHERE Name = " + quoted(name));
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  if (rows->empty()) {
    return fail(fmt::format("no machine is called \"{}\": `rmac machines` lists them", name));
  }
  auto machine = rows->front();
  const auto joints = joints_if_loaded(connection, name);
  if (!joints) {
    return tl::unexpected(joints.error());
  }
  if (json) {
    if (!joints->is_null()) {
      machine["Joints"] = *joints;
    }
    fmt::print("{}\n", machine.dump());
    return {};
  }
  std::vector<std::vector<std::string>> lines;
  lines.reserve(kColumns.size());
  for (const auto& column : kColumns) {
    lines.push_back({column.title, text_of(machine.at(column.key)), column.unit});
  }
  fmt::print("{}", table({"", "", ""}, lines));
  if (!joints->is_null()) {
    print_joints(*joints);
  }
  return {};
}

Result<> plot_machine(const std::string& name, const std::string& picture, const std::filesystem::path& device_tree) {
  const auto tree = device_tree.empty() ? gateway::default_folders().device_tree : device_tree;
  const auto drawn = run_helper("show_machine.py", {tree.string(), name, picture});
  return drawn ? Result<>() : tl::unexpected(drawn.error());
}

Result<> load_machine(Connection& connection, const std::string& name, bool virtual_mode) {
  return with_authority(connection, [&]() -> Result<> {
    const auto loaded = connection.call("Device.Load", {{"Name", name}, {"Virtual", virtual_mode}});
    return loaded ? Result<>() : tl::unexpected(loaded.error());
  });
}

Result<> unload_machine(Connection& connection) {
  return with_authority(connection, [&]() -> Result<> {
    const auto unloaded = connection.call("Device.Unload");
    return unloaded ? Result<>() : tl::unexpected(unloaded.error());
  });
}

}  // namespace rmac::cli
