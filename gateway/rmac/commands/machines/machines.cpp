#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>

#include "gateway/rmac/commands/machines/driver_records.hpp"
#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/simulator/fits.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

/// What is looked for. Numbers are lower bounds, in the units of the database.
struct Search {
  std::string type, configuration;
  std::optional<int> joints;
  std::string volume;  ///< LxWxD, mm
  std::optional<double> spindle_hp;
  std::string sql;                    ///< instead of all of the above
  std::string program;                ///< what they shall machine, a .rmac file; empty: nothing
  std::filesystem::path device_tree;  ///< in which they are simulated; empty: the installation's
  std::filesystem::path tools;        ///< folder of their tool tables then; empty: no tools but the program's own
};

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

Result<std::string> sql_of(const Search& search) {
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

/// Puts under each machine what it makes of the program.
Result<> add_fits(const Search& search, nlohmann::json& machines) {
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

Result<> list_machines(Connection& connection, const Search& search, bool json) {
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

}  // namespace

void add_machines(Command& rmac) {
  const auto search = std::make_shared<Search>();
  Command machines = rmac.add("machines", "list the machines that the appliance knows, or search them");
  machines.option("--type", &search->type, "Mill, CMM, Robot, …");
  machines.option("--configuration", &search->configuration, "3-axis, 5-axis, …");
  machines.option("--joints", &search->joints, "exactly so many joints");
  machines.option("--volume", &search->volume, "a working volume of at least LxWxD, mm");
  machines.option("--spindle-hp", &search->spindle_hp, "a spindle of at least so many horse powers");
  machines.option("--sql", &search->sql, "a SELECT over the table DeviceDrivers instead")
      .excludes({"--type", "--configuration", "--joints", "--volume", "--spindle-hp"});
  machines.option("--fits", &search->program,
                  "simulate this .rmac file on each that is found: how long it takes, or why it cannot");
  machines.option("--device-tree", &search->device_tree,
                  "where they are looked for to be simulated; the installation's unless given");
  machines.option("--tools", &search->tools, "folder of tool tables (tools/ of an appliance's state folder); only read")
      .existing_folder();
  machines.does(
      with_appliance([search](Connection& appliance, bool json) { return list_machines(appliance, *search, json); }));
}

}  // namespace rmac::cli
