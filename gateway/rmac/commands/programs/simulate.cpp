#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <utility>

#include "gateway/configuration/configuration.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/rmac/commands/programs/collision_report.hpp"
#include "gateway/rmac/commands/programs/dynamics_report.hpp"
#include "gateway/rmac/commands/programs/force_report.hpp"
#include "gateway/rmac/commands/programs/material_report.hpp"
#include "gateway/rmac/commands/programs/registrations.hpp"
#include "gateway/rmac/commands/programs/run_files.hpp"
#include "gateway/rmac/commands/programs/source.hpp"
#include "gateway/rmac/commands/programs/view_report.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"
#include "gateway/rmac/simulator/simulator.hpp"
#include "gateway/rmac/simulator/watch_verdict.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/threads/cpu_progress.hpp"
#include "gateway/threads/cpu_time.hpp"
#include "gateway/threads/hang_watch.hpp"

namespace rmac::cli {
namespace {

struct SimulateOptions {
  Source source;
  std::string machine;                ///< a name in the device tree, or the path of a device.json; empty: the program's
  std::filesystem::path device_tree;  ///< empty: the installation's
  std::string record_file;            ///< empty: none
  std::filesystem::path tools;        ///< folder of tool tables; empty: no tools but the program's own
  std::filesystem::path setup;        ///< what stands on the table; empty: collisions are not checked
  std::optional<double> resolution;   ///< of the material, mm; none: the set-up's
  std::filesystem::path materials;    ///< work materials that are known; empty: the installation's
  std::string stock_out;              ///< STL file of what is left of the stock; empty: none
  std::string view;                   ///< page that shows the machine moving; empty: none
  bool dynamics = false;              ///< go by what the axes do, not by where they are told to be
  bool first = false;                 ///< end at the first collision
  bool by_move = false;               ///< tell each move's limit too
  double period_s = 0.001;
};

/// CPU time of this program, s: what else the computer does does not count.
double cpu_time_s() {
  return std::chrono::duration<double>(gateway::cpu_time(CLOCK_PROCESS_CPUTIME_ID)).count();
}

nlohmann::json limits_json(const std::vector<MoveLimit>& limits) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [move_id, limit] : limits) list.push_back({{"move_id", move_id}, {"limit", limit}});
  return list;
}

/// What there is to tell of beside the motion.
struct Beside {
  const CollisionWatch* watch = nullptr;     ///< null without a set-up
  const MaterialReport* material = nullptr;  ///< null without a stock
  const ViewReport* view = nullptr;          ///< null where no page was asked for
  const DynamicsWatch* dynamics = nullptr;   ///< null where nobody asked what the axes do
  std::optional<double> keeps_at;            ///< the feed override at which they keep to the program, %
};

void print_simulation_json(const SimulationReport& report, const Beside& beside, bool by_move, double took_s) {
  const auto& [watch, material, view, dynamics, keeps_at] = beside;
  nlohmann::json joints = nlohmann::json::array();
  for (const auto& joint : report.joints) {
    joints.push_back({{"name", joint.name},
                      {"peak_velocity", joint.peak_velocity},
                      {"peak_acceleration", joint.peak_acceleration},
                      {"peak_jerk", joint.peak_jerk}});
  }
  nlohmann::json limited_by = nlohmann::json::object();
  for (const auto& [limit, time_s] : report.limited_by) limited_by[limit] = time_s;
  nlohmann::json line{{"cycle_time_s", report.cycle_time_s}, {"moves", report.moves},
                      {"tool_changes", report.tool_changes}, {"length_mm", report.length_mm},
                      {"joints", std::move(joints)},         {"limited_by_s", std::move(limited_by)},
                      {"collisions", "not checked"},         {"cpu_time_s", took_s}};
  if (by_move) line["move_limits"] = limits_json(report.move_limits);
  if (watch != nullptr) add_collisions(*watch, line);
  if (material != nullptr) line["material"] = to_json(*material);
  line["forces"] = forces_json(watch, by_move);
  line["dynamics"] = dynamics_json(dynamics, keeps_at);
  if (!report.record_files.empty()) {
    line["record_rows"] = report.record_rows;
    line["record_files"] = report.record_files;
  }
  if (view != nullptr) add_to_json(*view, line);
  // A file's name may hold any bytes.
  fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_simulation_table(const SimulationReport& report, const Beside& beside, double took_s) {
  const auto& [watch, material, view, dynamics, keeps_at] = beside;
  std::vector<std::vector<std::string>> rows{
      {"moves", std::to_string(report.moves), ""},
      {"tool changes", std::to_string(report.tool_changes), report.tool_changes > 0 ? "in no time" : ""},
      {"length", number(report.length_mm), "mm"},
      {"cycle time", number(report.cycle_time_s), "s"},
      {"computed in", number(took_s),
       fmt::format("s of CPU time, {:.0f} times real time", report.cycle_time_s / took_s)},
      {"collisions", watch == nullptr ? "not checked" : summary(*watch), watch == nullptr ? "name a --setup" : ""}};
  for (const auto& record : report.record_files) {
    rows.push_back({"record", record, fmt::format("{} rows in all", report.record_rows)});
  }
  if (view != nullptr) rows.push_back(row_of(*view));
  if (material != nullptr) add_rows(*material, rows);
  add_force_rows(watch, rows);
  if (dynamics != nullptr) add_dynamics_rows(*dynamics, rows);
  fmt::print("{}\n", table({"", "", ""}, rows));
  if (watch != nullptr) print_collisions(*watch);
  if (watch != nullptr) print_forces(*watch);
  if (dynamics != nullptr) print_dynamics(*dynamics, keeps_at);
  rows.clear();
  for (const auto& joint : report.joints) {
    rows.push_back({joint.name, number(joint.peak_velocity), number(joint.peak_acceleration), number(joint.peak_jerk)});
  }
  fmt::print("{}\n", table({"joint", "peak velocity /s", "acceleration /s²", "jerk /s³"}, rows));
  rows.clear();
  double in_motion_s = 0;
  for (const auto& share : report.limited_by) in_motion_s += share.time_s;
  for (const auto& [limit, time_s] : report.limited_by) {
    rows.push_back({limit, number(time_s), number(100 * time_s / in_motion_s, 1)});
  }
  fmt::print("{}", table({"limited by", "s", "%"}, rows));
}

/// Ends the program with exit code 1 where the simulation computes and computes, and machine time stands.
class StandstillWatch {
 public:
  /// Watches the calling thread.
  explicit StandstillWatch(const gateway::Controller& controller)
      : controller_(controller), watch_([this] { return look(); }, give_up) {}

 private:
  static constexpr std::chrono::seconds kPatience{10};

  [[nodiscard]] std::optional<std::string> look() {
    const std::int64_t cycle = controller_.sample().cycle;
    if (std::exchange(cycle_, cycle) != cycle) progress_.made();
    if (!progress_.stuck()) return std::nullopt;
    return fmt::format(
        "no progress in {} s of CPU time, in cycle {}: the planner, or a module of the mechanism that it calls, hangs",
        kPatience.count(), cycle);
  }
  static void give_up(const std::string& what) {
    fmt::print(stderr, "rmac: {}\n", what);
    std::_Exit(1);
  }

  const gateway::Controller& controller_;
  std::int64_t cycle_ = -1;
  gateway::CpuProgress progress_{kPatience};
  gateway::HangWatch watch_;  // last: it looks at the others
};

/// Refuses what cannot be told of this program, before anything is planned.
Result<> check_options(const SimulateOptions& options, const Program& program, bool json) {
  if (options.machine.empty() && !program.loads_mechanism) {
    return fail(fmt::format("{}: the program loads no machine; name one with --machine", program.file));
  }
  if (options.machine.empty() && !options.setup.empty())
    return fail("--setup needs --machine: what stands on which table");
  if (options.machine.empty() && !options.view.empty()) return fail("--view needs --machine: which one is shown");
  if (options.machine.empty() && options.dynamics) return fail("--dynamics needs --machine: whose axes they are");
  if (options.by_move && !json) return fail("--by-move needs --json: it tells something of every move");
  if (options.first && options.setup.empty())
    return fail("--first needs --setup: without one collisions are not checked");
  if (options.resolution && options.setup.empty())
    return fail("--resolution needs --setup: without one there is no stock");
  if (!options.materials.empty() && options.setup.empty())
    return fail("--materials needs --setup: without one nothing is cut");
  if (!options.stock_out.empty() && options.setup.empty())
    return fail("--stock-out needs --setup: without one there is no stock");
  return {};
}

std::filesystem::path materials_of(const SimulateOptions& options) {
  return options.materials.empty() ? gateway::default_folders().materials : options.materials;
}

/// Nothing that is written takes the place of what is read, or written otherwise. `collisions` and `shown` may be null.
Result<> check_written(const SimulateOptions& options, const std::filesystem::path& tree,
                       const CollisionWatch* collisions, const ShapedMachine* shown) {
  std::vector<std::filesystem::path> used = files_in(options.tools);
  used.emplace_back(options.source.file);
  // A machine that the program loads is known when it does.
  if (const auto device_json = gateway::find_device_json(options.machine, tree); device_json) {
    std::ranges::copy(files_in(device_json->parent_path()), std::back_inserter(used));
  }
  if (collisions != nullptr) {
    used.insert(used.end(), {options.setup, materials_of(options)});
    std::ranges::copy(files_of(collisions->setup()), std::back_inserter(used));
  }
  if (!options.record_file.empty()) {
    if (auto fine = refuse_used(options.record_file, "--record", used); !fine) return fine;
    used.emplace_back(options.record_file);
  }
  if (shown != nullptr) {
    if (auto fine = check_view(options.view, *shown, used); !fine) return fine;
    used.emplace_back(options.view);
  }
  if (options.stock_out.empty()) return {};
  if (collisions == nullptr || collisions->material() == nullptr) {
    return fail(
        fmt::format("{}: has no Stock, so that nothing can be left of it for --stock-out", options.setup.string()));
  }
  return check_stock_out(options.stock_out, used);
}

/// Null without a set-up.
Result<std::unique_ptr<CollisionWatch>> open_watch(const SimulateOptions& options, const std::filesystem::path& tree,
                                                   gateway::Simulation& simulation) {
  if (options.setup.empty()) return nullptr;
  auto setup = gateway::read_setup(options.setup);
  if (!setup) return fail(setup.error().message);
  auto watch = CollisionWatch::open(
      options.machine, tree, std::move(*setup),
      {.setup_file = options.setup, .resolution_mm = options.resolution, .materials = materials_of(options)});
  if (!watch) return watch;
  if (!options.materials.empty() && (*watch)->setup().material.empty()) {
    return fail(
        fmt::format("{}: names no Material, so that nothing is looked up in --materials", options.setup.string()));
  }
  if (auto placed = (*watch)->place_part(simulation); !placed) return tl::unexpected(placed.error());
  return watch;
}

/// None where no page is asked for.
Result<std::optional<ShapedMachine>> shown_machine(const SimulateOptions& options, const std::filesystem::path& tree) {
  if (options.view.empty()) return std::nullopt;
  auto machine = read_shaped_machine(options.machine, tree, "there is nothing to show with --view");
  if (!machine) return tl::unexpected(machine.error());
  return std::move(*machine);
}

/// A machine, and what watches it, before a program runs.
struct Parts {
  std::unique_ptr<gateway::Simulation> simulation;
  std::unique_ptr<CollisionWatch> collisions;  ///< null without a set-up
  std::unique_ptr<DynamicsWatch> dynamics;     ///< null where nobody asked what the axes do
};

Result<Parts> open_parts(const SimulateOptions& options, const std::filesystem::path& tree) {
  auto simulation = gateway::Simulation::open({.device_tree = tree,
                                               .searcher = gateway::default_folders().searcher,
                                               .tools_folder = options.tools,
                                               .period_s = options.period_s},
                                              options.machine);
  if (!simulation) return fail(simulation.error().message);
  auto collisions = open_watch(options, tree, **simulation);
  if (!collisions) return tl::unexpected(collisions.error());
  Parts parts{std::move(*simulation), std::move(*collisions), nullptr};
  if (!options.dynamics) return parts;
  auto dynamics = DynamicsWatch::open(options.machine, tree, options.period_s, parts.collisions.get());
  if (!dynamics) return tl::unexpected(dynamics.error());
  parts.dynamics = std::move(*dynamics);
  return parts;
}

/// The largest of some shares of its feed overrides, %, at which the axes keep to the program; none where not even the
/// least is.
Result<std::optional<double>> feed_that_keeps(const SimulateOptions& options, const std::filesystem::path& tree,
                                              const Program& program) {
  for (const double percent : {80.0, 65.0, 50.0, 40.0, 30.0, 20.0, 10.0}) {
    const auto parts = open_parts(options, tree);
    if (!parts) return tl::unexpected(parts.error());
    Simulator simulator(*parts->simulation, program, "");
    if (parts->collisions) simulator.watch_collisions(*parts->collisions, false);
    simulator.go_by(*parts->dynamics, true);
    simulator.slow_down(percent / 100);
    const auto run = simulator.run();
    if (run && keeps_to_program(*parts->dynamics)) return percent;
  }
  return std::nullopt;
}

Result<> simulate_program(const SimulateOptions& options, bool json) {
  const double began_s = cpu_time_s();
  const auto program = read_source(options.source);
  if (!program) return tl::unexpected(program.error());
  if (auto fine = check_options(options, *program, json); !fine) return fine;
  spdlog::set_level(spdlog::level::off);  // what is wrong with other machines of the tree is not asked here
  const auto tree = options.device_tree.empty() ? gateway::default_folders().device_tree : options.device_tree;
  const auto parts = open_parts(options, tree);
  if (!parts) return tl::unexpected(parts.error());
  CollisionWatch* const watched = parts->collisions.get();
  DynamicsWatch* const dynamics = parts->dynamics.get();
  const auto shown = shown_machine(options, tree);
  if (!shown) return tl::unexpected(shown.error());
  if (auto fine = check_written(options, tree, watched, *shown ? &**shown : nullptr); !fine) return fine;
  std::optional<Film> film;
  if (*shown) {
    auto drawn = drawn_bodies((*shown)->bodies, watched != nullptr ? &watched->setup() : nullptr);
    if (!drawn) return tl::unexpected(drawn.error());
    film.emplace(**shown, watched, std::move(*drawn));
  }
  std::optional<StandstillWatch> watch(std::in_place, parts->simulation->controller());
  Simulator simulator(*parts->simulation, *program, options.record_file);
  if (watched != nullptr) simulator.watch_collisions(*watched, options.first);
  if (dynamics != nullptr) simulator.go_by(*dynamics, false);
  if (film) simulator.listen(*film);
  const auto report = simulator.run();
  watch.reset();  // machine time is over: what is told of the material may take long
  if (!report) return tl::unexpected(report.error());
  std::optional<MaterialReport> material;
  if (watched != nullptr && watched->material() != nullptr) {
    auto found = report_material(*watched, options.stock_out);
    if (!found) return tl::unexpected(found.error());
    material = std::move(*found);
  }
  std::optional<ViewReport> view;
  if (film) {
    film->end();
    auto written = report_view(*film, watched, options.source.file, options.view);
    if (!written) return tl::unexpected(written.error());
    view = std::move(*written);
  }
  const Result<> met = watched != nullptr ? verdict(*watched) : Result<>();
  const Result<> held = dynamics != nullptr ? verdict(*dynamics) : Result<>();
  std::optional<double> keeps;
  if (dynamics != nullptr && !keeps_to_program(*dynamics)) {
    auto found = feed_that_keeps(options, tree, *program);
    if (!found) return tl::unexpected(found.error());
    keeps = *found;
  }
  const Beside beside{watched, material ? &*material : nullptr, view ? &*view : nullptr, dynamics, keeps};
  const double took_s = cpu_time_s() - began_s;
  if (json) {
    print_simulation_json(*report, beside, options.by_move, took_s);
  } else {
    print_simulation_table(*report, beside, took_s);
  }
  return both(met, held);
}

}  // namespace

void add_simulate(Command& rmac) {
  const auto options = std::make_shared<SimulateOptions>();
  Command simulate = rmac.add(
      "simulate", "only plan a program, faster than real time: cycle time, limits, collisions; needs no appliance");
  declare_source(simulate, options->source);
  simulate.option("--machine", &options->machine,
                  "a machine's name, or the path of its device.json; needed unless the program loads one");
  simulate.option("--record", &options->record_file, "write every cycle's setpoints to this CSV");
  simulate
      .option("--tools", &options->tools, "folder of tool tables (tools/ of an appliance's state folder); only read")
      .existing_folder();
  simulate.option("--setup", &options->setup, "setup.json: what stands on the table; collisions are checked with it");
  simulate.option("--resolution", &options->resolution,
                  "with --setup: how far the rays are apart by which the stock is known, mm; instead of the set-up's");
  simulate.option("--materials", &options->materials,
                  "with --setup: file of the work materials that are known; the installation's unless given");
  simulate.option("--stock-out", &options->stock_out, "with --setup: write what is left of the stock to this STL file");
  simulate.option("--view", &options->view,
                  "write a page (.html) that shows the machine moving, its limits and what --setup found");
  simulate.flag("--dynamics", &options->dynamics,
                "close the servo loops over the models of the machine's axes: what they do is what is watched and cut");
  simulate.flag("--first", &options->first, "with --setup: end at the first collision");
  simulate.flag("--by-move", &options->by_move,
                "with --json: the limit that ruled each move for the longest time, and what cutting it took");
  simulate.option("--device-tree", &options->device_tree,
                  "where machines are looked for; the installation's unless given");
  simulate.option("--period", &options->period_s, "cycle of the servo loop, s (period_s in rmacd.json)")
      .within(0.0001, 0.1)
      .shows_default();
  simulate.does(without_appliance([options](bool json) { return simulate_program(*options, json); }));
}

}  // namespace rmac::cli
