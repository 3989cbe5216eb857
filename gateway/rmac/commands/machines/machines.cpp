#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <tuple>

#include "gateway/collision/setup/setup.hpp"
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
  std::filesystem::path setup;        ///< what is clamped on each then; empty: nothing
  std::filesystem::path materials;    ///< the work materials that are known; empty: the installation's
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

Result<> check_fits(const Search& search) {
  if (search.program.empty() && !search.setup.empty())
    return fail("--setup needs --fits: a program that is simulated in it");
  if (search.setup.empty() && !search.materials.empty()) {
    return fail("--materials needs --setup: without one nothing is cut");
  }
  return {};
}

/// Puts under each machine what it makes of the program, and those first that fit: the fastest, of these the most
/// accurate, of these the one whose spindle has most left.
Result<> add_fits(const Search& search, nlohmann::json& machines) {
  auto program = read_program(search.program);
  if (!program) {
    return tl::unexpected(program.error());
  }
  if (!search.setup.empty()) {
    if (const auto setup = gateway::read_setup(search.setup); !setup) return fail(setup.error().message);
  }
  const FitQuestion question{.program = std::move(*program),
                             .device_tree = search.device_tree,
                             .tools = search.tools,
                             .setup_file = search.setup,
                             .materials = search.materials};
  for (auto& machine : machines) {
    const Fit fit = fit_of(question, machine.at("Name").get<std::string>());
    machine["Fits"] = fit.fits;
    if (fit.fits) {
      machine["CycleTime_s"] = fit.cycle_time_s;
    } else {
      machine["WhyNot"] = fit.why_not;
    }
    if (fit.spindle_used) machine["SpindleUsed"] = *fit.spindle_used;
  }
  const auto rank = [](const nlohmann::json& machine) {
    return std::tuple(!machine.at("Fits").get<bool>(), machine.value("CycleTime_s", 0.0),
                      machine.value("PositioningTolerance", 0.0), machine.value("SpindleUsed", 0.0));
  };
  std::stable_sort(machines.begin(), machines.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return {};
}

void print_fits(const nlohmann::json& machines) {
  std::vector<std::vector<std::string>> cells;
  for (const auto& machine : machines) {
    const bool fits = machine.at("Fits").get<bool>();
    cells.push_back(
        {machine.at("Name").get<std::string>(), text_of(machine.at("NumberOfJoints")),
         fits ? number(machine.at("CycleTime_s").get<double>()) : "",
         fits ? text_of(machine.at("PositioningTolerance")) : "",
         machine.contains("SpindleUsed") ? fmt::format("{:.0f}", 100 * machine["SpindleUsed"].get<double>()) : "",
         fits ? "" : machine.at("WhyNot").get<std::string>()});
  }
  fmt::print("{}", table({"name", "joints", "cycle time s", "accuracy mm", "of the spindle %", "why not"}, cells));
}

Result<> list_machines(Connection& connection, const Search& search, bool json) {
  if (auto fine = check_fits(search); !fine) return fine;
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
  machines.option("--setup", &search->setup,
                  "what is clamped, a setup.json; it stands on each table as on its own machine's: those that would "
                  "collide, or whose spindle has not enough, do not fit");
  machines.option("--materials", &search->materials,
                  "the work materials that are known, instead of etc/materials.json");
  machines.option("--device-tree", &search->device_tree,
                  "where they are looked for to be simulated; the installation's unless given");
  machines.option("--tools", &search->tools, "folder of tool tables (tools/ of an appliance's state folder); only read")
      .existing_folder();
  machines.does(
      with_appliance([search](Connection& appliance, bool json) { return list_machines(appliance, *search, json); }));
}

}  // namespace rmac::cli
