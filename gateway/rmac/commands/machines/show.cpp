#include <fmt/format.h>

#include <array>

#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/commands/machines/driver_records.hpp"
#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/plots/plot_program.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

struct ShowOptions {
  std::string name;
  std::string picture;                ///< empty: none
  std::filesystem::path device_tree;  ///< empty: the installation's
};

constexpr std::array kJointColumns{
    Column{"Machine_GetMechanismJntTypes", "Type", "Type", ""},
    Column{"Machine_GetMechanismJntMinLimit", "Min", "Min", ""},
    Column{"Machine_GetMechanismJntMaxLimit", "Max", "Max", ""},
    Column{"Machine_GetMechanismJntMaxSpeed", "MaxSpeed", "MaxSpeed", ""},
    Column{"Machine_GetMechanismJntMaxAccel", "MaxAcceleration", "MaxAcceleration", ""},
    Column{"Machine_GetMechanismJntMaxJerk", "MaxJerk", "MaxJerk", ""},
    Column{"Machine_GetMechanismJntServoControlLaw", "ServoControlLaw", "ServoControlLaw", ""}};

/// The joints of the loaded mechanism, when it is `name`; null otherwise.
Result<nlohmann::json> joints_if_loaded(Connection& connection, const std::string& name) {
  const auto loaded = loaded_machine(connection);
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
    header.emplace_back(column.title);
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
  lines.reserve(columns().size());
  for (const auto& column : columns()) {
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
  const auto drawn = run_plot("show_machine.py", {tree.string(), name, picture});
  return drawn ? Result<>() : tl::unexpected(drawn.error());
}

}  // namespace

void add_show(Command& rmac) {
  const auto options = std::make_shared<ShowOptions>();
  Command show = rmac.add("show", "a machine's characteristics; of the loaded one its joints too");
  show.option("NAME", &options->name, "as `rmac machines` lists it").required();
  show.option("--plot", &options->picture, "draw its reach and its joints' limits here; needs python3-matplotlib");
  show.option("--device-tree", &options->device_tree,
              "where its device.json is looked for to be drawn; the installation's unless given");
  show.does(with_appliance([options](Connection& appliance, bool json) -> Result<> {
    const auto shown = show_machine(appliance, options->name, json);
    if (!shown || options->picture.empty()) return shown;
    return plot_machine(options->name, options->picture, options->device_tree);
  }));
}

}  // namespace rmac::cli
