#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>

#include "gateway/json/finite_numbers.hpp"
#include "gateway/json/printable.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/measuring_options.hpp"
#include "rmac/motion/pose.hpp"

namespace {

using namespace rmac::cli;
namespace gateway = rmac::gateway;

/// Of any machine; what the one that is loaded has, it says itself.
CLI::Range joint_numbers() {
  return {0, static_cast<int>(rmac::kMaxJoints) - 1};
}

using OfflineCommand = std::function<Result<>()>;

/// The command line as a person typed it; each option is bound to one of these.
struct Arguments {
  DriveMove move;
  LssAssignment assignment;
  std::uint32_t bit_rate = 0;
  double switch_delay_s = 10;
  Endpoint endpoint;
  bool json = false, watch = false, load_virtual = false;
  std::string name, file, folder;
  MachineSearch search;
  RunOptions run;
  SimulateOptions simulate;
  JogRequest jog;
  TuneRequest tune;
  MeasureRequest measure;
  QualifyRequest qualify;
  ToolRequest tool;
  std::optional<double> back_from_mm;
  std::optional<int> tool_number;
  FollowingRequest following;
  int node = 0;
  double percent = 100, period_s = 0.001;
};

void add_database_commands(CLI::App& app, Arguments& arguments, Command& command) {
  auto* machines = app.add_subcommand("machines", "list the machines that the appliance knows, or search them");
  auto& search = arguments.search;
  machines->add_option("--type", search.type, "Mill, CMM, Robot, …");
  machines->add_option("--configuration", search.configuration, "3-axis, 5-axis, …");
  machines->add_option("--joints", search.joints, "exactly so many joints");
  machines->add_option("--volume", search.volume, "a working volume of at least LxWxD, mm");
  machines->add_option("--spindle-hp", search.spindle_hp, "a spindle of at least so many horse powers");
  machines->add_option("--sql", search.sql, "a SELECT over the table DeviceDrivers instead")
      ->excludes("--type", "--configuration", "--joints", "--volume", "--spindle-hp");
  machines->add_option("--fits", search.program,
                       "simulate this .rmac file on each that is found: how long it takes, or why it cannot");
  machines->add_option("--device-tree", search.device_tree,
                       "where they are looked for to be simulated; the installation's unless given");
  machines
      ->add_option("--tools", search.tools, "folder of tool tables (tools/ of an appliance's state folder); only read")
      ->check(CLI::ExistingDirectory);
  machines->callback([&] { command = [&](auto& to) { return list_machines(to, arguments.search, arguments.json); }; });

  auto* show = app.add_subcommand("show", "a machine's characteristics; of the loaded one its joints too");
  show->add_option("NAME", arguments.name, "as `rmac machines` lists it")->required();
  show->add_option("--plot", arguments.file, "draw its reach and its joints' limits here; needs python3-matplotlib");
  show->add_option("--device-tree", search.device_tree,
                   "where its device.json is looked for to be drawn; the installation's unless given");
  show->callback([&] {
    command = [&](auto& to) {
      return show_machine(to, arguments.name, arguments.json).and_then([&]() -> Result<> {
        return arguments.file.empty() ? Result<>() : plot_machine(arguments.name, arguments.file, search.device_tree);
      });
    };
  });

  auto* load = app.add_subcommand("load", "make a machine's driver configure the controller");
  load->add_option("NAME", arguments.name, "as `rmac machines` lists it")->required();
  load->add_flag("--virtual", arguments.load_virtual, "setpoints come back as joint values, drives stay untouched");
  load->callback([&] { command = [&](auto& to) { return load_machine(to, arguments.name, arguments.load_virtual); }; });

  app.add_subcommand("unload", "take the loaded machine out")->callback([&] { command = unload_machine; });
}

void add_operating_commands(CLI::App& app, Arguments& arguments, Command& command) {
  auto* run = app.add_subcommand("run",
                                 "machine a program, one JSON-RPC request a line; when held, Enter goes on, a distance "
                                 "in mm runs back, p parks it");
  run->add_option("FILE", arguments.file, "the .rmac file, - for standard input")->required();
  run->add_flag("--virtual", arguments.run.virtual_mode, "in virtual mode: drives stay untouched");
  run->add_option("--record", arguments.run.record_file,
                  "write every cycle's setpoints and measured joints to this CSV");
  run->add_option("--machine", arguments.run.machine, "load this machine first");
  run->callback(
      [&] { command = [&](auto& to) { return run_program(to, arguments.file, arguments.run, arguments.json); }; });

  auto* status = app.add_subcommand("status", "what the machine does now");
  status->add_flag("--watch", arguments.watch, "go on until Ctrl-C");
  status->callback([&] { command = [&](auto& to) { return show_status(to, arguments.watch, arguments.json); }; });

  app.add_subcommand("cycles", "how late the servo cycles began, and what they took")->callback([&] {
    command = [&](auto& to) { return show_cycles(to, arguments.json); };
  });

  app.add_subcommand("events", "follow what happens until Ctrl-C")->callback([&] {
    command = [&](auto& to) { return show_events(to, arguments.json); };
  });

  JogRequest& request = arguments.jog;
  auto* jog_command = app.add_subcommand("jog", "move one joint, or the tool straight, from rest");
  auto* what = jog_command->add_option_group("what")->require_option(1);
  what->add_option("--joint", request.joint, "counted from 0")->check(joint_numbers());
  auto* direction =
      what->add_option("--direction", request.direction, "X Y Z of the tool's way, in the part frame")->expected(3);
  jog_command->add_flag("--tool", request.in_tool_frame, "the direction is the tool's own, Z along its axis")
      ->needs(direction);
  auto* how = jog_command->add_option_group("how")->require_option(1);
  how->add_option("--distance", request.distance, "mm or degrees, signed");
  how->add_option("--velocity", request.velocity, "mm/s or degrees/s, signed; until Ctrl-C");
  jog_command->callback([&] { command = [&](auto& to) { return jog(to, request); }; });

  app.add_subcommand("home", "move all joints to their home position")->callback([&] { command = home; });
  app.add_subcommand("hold", "feed hold: stop on the path, keep the program")->callback([&] { command = hold; });
  app.add_subcommand("resume", "go on after a hold")->callback([&] { command = resume; });
  app.add_subcommand("stop", "stop now and empty the queue")->callback([&] { command = stop; });
  app.add_subcommand("reset", "leave a fault or an emergency stop whose cause is gone; nothing moves by it")
      ->callback([&] { command = reset; });

  auto* parked = app.add_subcommand("parked", "the program that is parked: p and Enter at the terminal of `rmac run`");
  parked
      ->add_option("--back", arguments.back_from_mm,
                   "go back to its place, straight to so many mm above it along the tool, then down")
      ->check(CLI::Range(0.0, 10000.0));
  parked->callback(
      [&] { command = [&](auto& to) { return show_parked(to, arguments.back_from_mm, arguments.json); }; });

  auto* override_command = app.add_subcommand("override", "scale the feed");
  override_command->add_option("PERCENT", arguments.percent, "0 to 200")->required()->check(CLI::Range(0.0, 200.0));
  override_command->callback([&] { command = [&](auto& to) { return set_override(to, arguments.percent); }; });
}

void add_tool_commands(CLI::App& app, Arguments& arguments, Command& command) {
  const CLI::Range numbers(1, 9999);
  auto* tools = app.add_subcommand("tools", "the tool table of the loaded machine, and what is in its spindle");
  tools->require_subcommand(0, 1);
  tools->preparse_callback([&](std::size_t) { command = [&](auto& to) { return list_tools(to, arguments.json); }; });
  tools->add_subcommand("list", "the tools; what `rmac tools` alone does")->callback([&] {
    command = [&](auto& to) { return list_tools(to, arguments.json); };
  });
  ToolRequest& tool = arguments.tool;
  auto* set = tools->add_subcommand("set", "add a tool, or change what is given of one that is there");
  set->add_option("NUMBER", tool.number, "1 to 9999")->required()->check(numbers);
  set->add_option("--length", tool.length_mm, "from where it sits to its tip, mm");
  set->add_option("--radius", tool.radius_mm, "mm");
  set->add_option("--name", tool.name, "for people");
  set->add_option("--frame", tool.frame, "where it sits on the tool interface: x y z, mm, and the quaternion w x y z")
      ->expected(7);
  set->add_option("--max-rpm", tool.max_rpm, "fastest that it may turn; 0: as fast as the spindle can");
  set->add_option("--max-torque", tool.max_torque_nm, "N·m; 0: not given");
  set->add_option("--needs-spindle", tool.needs_spindle, "whether it cuts only while the spindle turns");
  set->callback([&] { command = [&](auto& to) { return set_tool(to, arguments.tool); }; });
  auto* remove = tools->add_subcommand("remove", "take a tool out of the table");
  remove->add_option("NUMBER", tool.number, "1 to 9999")->required()->check(numbers);
  remove->callback([&] { command = [&](auto& to) { return remove_tool(to, arguments.tool.number); }; });

  auto* confirm = app.add_subcommand("confirm", "say that the tool that was asked for is in the spindle");
  confirm
      ->add_option("NUMBER", arguments.tool_number, "the tool that is there; 0: none; the one asked for unless given")
      ->check(CLI::Range(0, 9999));
  confirm->callback([&] { command = [&](auto& to) { return confirm_tool(to, arguments.tool_number); }; });
}

void add_trace_commands(CLI::App& app, Arguments& arguments, Command& command) {
  auto* trace = app.add_subcommand("trace", "the flight records: what every cycle did before a fault, or up to now");
  trace->require_subcommand(0, 1);
  trace->preparse_callback([&](std::size_t) { command = [&](auto& to) { return list_records(to, arguments.json); }; });
  trace->add_subcommand("list", "the records that there are, oldest first; what `rmac trace` alone does")
      ->callback([&] { command = [&](auto& to) { return list_records(to, arguments.json); }; });
  trace->add_subcommand("record", "have the last seconds written now, and wait for it")->callback([&] {
    command = [&](auto& to) { return make_record(to, arguments.json); };
  });
  auto* exports = trace->add_subcommand("export", "write a record as CSV, one row a cycle");
  auto* plot = trace->add_subcommand("plot", "draw a record; needs python3-matplotlib");
  for (auto* of_one : {exports, plot}) {
    of_one->add_option("NAME", arguments.name, "as `rmac trace list` shows it; the newest one unless given");
    of_one->add_option("-o,--output", arguments.file, "the file to write; NAME.csv or NAME.png here unless given");
  }
  exports->callback([&] { command = [&](auto& to) { return export_record(to, arguments.name, arguments.file); }; });
  plot->callback([&] { command = [&](auto& to) { return plot_record(to, arguments.name, arguments.file); }; });
}

void add_commissioning_commands(CLI::App& app, Arguments& arguments, Command& command) {
  TuneRequest& request = arguments.tune;
  auto* tune_command = app.add_subcommand(
      "tune",
      "move a joint, find its mass, friction and delay, and propose gains; needs python3-scipy and -matplotlib");
  tune_command->add_option("JOINT", request.joint, "counted from 0")->required()->check(joint_numbers());
  tune_command->add_option("--travel", request.travel, "mm or degrees that it may go from where it stands, signed")
      ->required();
  tune_command->add_option("--bandwidth", request.bandwidth_hz, "Hz; nine tenths of what its delay allows unless given")
      ->check(CLI::PositiveNumber);
  tune_command->add_option("--phase-margin", request.phase_margin_deg, "degrees")
      ->check(CLI::Range(10.0, 70.0))
      ->capture_default_str();
  tune_command->add_option("-o,--output", request.picture, "the picture to draw; tune-JOINT.png here unless given");
  tune_command->add_flag("--apply", request.apply, "put the gains in force; without it nothing is changed");
  tune_command->callback([&] { command = [&](auto& to) { return tune(to, request, arguments.json); }; });

  FollowingRequest& circle = arguments.following;
  auto* follow = app.add_subcommand("measure-following",
                                    "go round a circle from where the tool stands (upwards in Y) and draw what a "
                                    "ballbar would (ISO 230-4)");
  follow->add_option("--radius", circle.radius_mm, "mm")->check(CLI::Range(0.1, 10000.0))->capture_default_str();
  follow->add_option("--feed", circle.feed_mm_min, "mm/min; the machine's largest unless given")
      ->check(CLI::PositiveNumber);
  follow->add_option("-o,--output", circle.picture, "the picture to draw; following.png here unless given");
  follow->callback([&] { command = [&](auto& to) { return measure_following(to, circle, arguments.json); }; });
}

/// Commands that need no appliance, or not always.
void add_lss_commands(CLI::App& bus, Arguments& arguments, OfflineCommand& command) {
  auto* lss = bus.add_subcommand("lss", "node ids and bit rates over the bus (CiA 305)");
  lss->require_subcommand(1);
  auto* scan = lss->add_subcommand("scan", "list the nodes that have no node id");
  scan->add_option("INTERFACE", arguments.name, "a CAN interface that is up: can0")->required();
  scan->callback([&] { command = [&] { return lss_scan(arguments.name, arguments.json); }; });
  auto* assign = lss->add_subcommand("assign", "give a node an id: the one that has none, or the one of --identity");
  assign->add_option("INTERFACE", arguments.assignment.interface, "a CAN interface that is up: can0")->required();
  assign->add_option("NODE", arguments.assignment.node, "its id from now on")->required()->check(CLI::Range(1, 126));
  assign
      ->add_option("--identity", arguments.assignment.identity,
                   "its vendor, product, revision and serial number; hexadecimal ones with 0x")
      ->expected(4);
  assign->callback([&] { command = [&] { return lss_assign(arguments.assignment); }; });
  auto* rate = lss->add_subcommand("bit-rate", "have all nodes take another bit rate, and say what is left to do");
  rate->add_option("INTERFACE", arguments.name, "a CAN interface that is up: can0")->required();
  rate->add_option("BITRATE", arguments.bit_rate, "bit/s")->required();
  rate->add_option("--delay", arguments.switch_delay_s, "s until they change, and again until they speak")
      ->check(CLI::Range(0.0, 65.0))
      ->capture_default_str();
  rate->callback([&] {
    command = [&] { return lss_set_bit_rate(arguments.name, arguments.bit_rate, arguments.switch_delay_s); };
  });
}

void add_bus_commands(CLI::App& app, Arguments& arguments, OfflineCommand& command) {
  auto* bus = app.add_subcommand("bus", "commission a fieldbus");
  bus->require_subcommand(1);
  add_lss_commands(*bus, arguments, command);
  auto* load =
      bus->add_subcommand("load", "the bits that a machine's CAN buses carry at worst; exit code 1 if too many");
  load->add_option("FILE", arguments.file, "the machine's device.json")->required();
  load->add_option("--period", arguments.period_s, "cycle of the servo loop, s (period_s in rmacd.json)")
      ->check(CLI::Range(0.0001, 0.1))
      ->capture_default_str();
  auto* scan =
      bus->add_subcommand("scan", "list the CANopen nodes on an interface; refuses a bus on which a machine runs");
  scan->add_option("INTERFACE", arguments.name, "a CAN interface that is up: can0")->required();
  scan->add_option("--eds", arguments.folder, "a folder of EDS and DCF files: say which are the nodes'")
      ->check(CLI::ExistingDirectory);
  scan->callback([&] { command = [&] { return scan_bus(arguments.name, arguments.folder, arguments.json); }; });
  const auto add_store = [&](const char* name, const char* what, bool defaults) {
    auto* store = bus->add_subcommand(name, what);
    store->add_option("INTERFACE", arguments.name, "a CAN interface that is up: can0")->required();
    store->add_option("NODE", arguments.node, "its node id")->required()->check(CLI::Range(1, 127));
    store->callback(
        [&, defaults] { command = [&, defaults] { return store_node(arguments.name, arguments.node, defaults); }; });
  };
  add_store("store", "have a node keep its parameters as they are now, without power too (1010h)", false);
  add_store("restore", "have a node take its maker's parameters from its next reset on (1011h)", true);
  auto* move = bus->add_subcommand(
      "move", "move one drive by itself, with the motor off the machine; refuses a bus on which a machine runs");
  move->add_option("INTERFACE", arguments.move.interface, "a CAN interface that is up: can0")->required();
  move->add_option("NODE", arguments.move.node, "the drive's node id")->required()->check(CLI::Range(1, 126));
  move->add_option("--mode", arguments.move.mode, "profile or cyclic synchronous position, velocity or torque, or ip")
      ->required()
      ->check(CLI::IsMember(trial_modes()));
  move->add_option("--amount", arguments.move.amount,
                   "the way in counts; velocity in the drive's units; torque in per mille of the rated one")
      ->required();
  move->add_option("--within", arguments.move.within, "counts from where it stands; beyond them it is stopped")
      ->required()
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{2147483647}));
  move->add_option("--seconds", arguments.move.seconds, "how long the way, the velocity or the torque lasts")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  move->add_option("--setup", arguments.move.setup, "objects to write first, as in device.json: \"6081:00/32=20000\"");
  move->callback([&] { command = [&] { return move_drive(arguments.move); }; });
  load->callback([&] { command = [&] { return show_bus_load(arguments.file, arguments.period_s, arguments.json); }; });
}

void add_offline_commands(CLI::App& app, Arguments& arguments, std::function<Result<>()>& command,
                          Command& online_command) {
  auto* simulate = app.add_subcommand(
      "simulate", "only plan a program, faster than real time: cycle time, limits; needs no appliance");
  simulate->add_option("FILE", arguments.file, "the .rmac file, - for standard input")->required();
  simulate->add_option("--machine", arguments.simulate.machine,
                       "a machine's name, or the path of its device.json; needed unless the program loads one");
  simulate->add_option("--record", arguments.simulate.record_file, "write every cycle's setpoints to this CSV");
  simulate
      ->add_option("--tools", arguments.simulate.tools,
                   "folder of tool tables (tools/ of an appliance's state folder); only read")
      ->check(CLI::ExistingDirectory);
  simulate->add_option("--device-tree", arguments.simulate.device_tree,
                       "where machines are looked for; the installation's unless given");
  simulate->add_option("--period", arguments.simulate.period_s, "cycle of the servo loop, s (period_s in rmacd.json)")
      ->check(CLI::Range(0.0001, 0.1))
      ->capture_default_str();
  simulate->callback(
      [&] { command = [&] { return simulate_program(arguments.file, arguments.simulate, arguments.json); }; });

  auto* verify = app.add_subcommand(
      "verify", "check a machine's modules, each in a process of its own; exit code 1 when it is refused");
  verify
      ->add_option("NAME", arguments.name,
                   "as `rmac machines` lists it; or the path of its folder or its device.json, which needs no "
                   "appliance")
      ->required();
  verify->add_option("--device-tree", arguments.folder,
                     "with a path: the tree whose shared modules it may name; the installation's unless given");
  verify->callback([&] {
    if (is_path(arguments.name)) {
      command = [&] { return verify_files(arguments.name, arguments.folder, arguments.json); };
    } else {
      online_command = [&](auto& to) { return verify_machine(to, arguments.name, arguments.json); };
    }
  });
}

int report(const Failure& failure) {
  // One line, whatever the message held: scripts read it so.
  const auto message = gateway::printable(failure.message.substr(0, failure.message.find_last_not_of('\n') + 1));
  fmt::print(stderr, "rmac: {}\n", message);
  return kExitFailed;
}

int report(const CLI::App& app, const CLI::ParseError& error) {
  // Of a word that is no command CLI11 tells only that a command is missing.
  const auto left = app.remaining(true);
  if (error.get_name() != "RequiredError" || left.empty()) return app.exit(error) == 0 ? kExitDone : kExitUsage;
  fmt::print(stderr, "rmac: there is no {}; rmac --help lists what there is\n", gateway::printable(left.front()));
  return kExitUsage;
}

int run(int count, char** words) {
  CLI::App app{"rmac talks to the fieldbus gateway appliance, rmacd.", "rmac"};
  app.set_version_flag("--version", RMAC_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  Arguments arguments;
  Command command;
  app.add_option("--socket", arguments.endpoint.socket, "UNIX socket of the appliance")->envname("RMAC_SOCKET");
  app.add_option("--host", arguments.endpoint.host, "host of the appliance")
      ->envname("RMAC_HOST")
      ->capture_default_str();
  app.add_option("--port", arguments.endpoint.port, "its TCP port")->envname("RMAC_PORT")->capture_default_str();
  app.add_flag("--json", arguments.json, "print for programs");
  add_database_commands(app, arguments, command);
  add_operating_commands(app, arguments, command);
  add_tool_commands(app, arguments, command);
  add_measuring_commands(app, arguments.measure, arguments.qualify, arguments.json, command);
  add_trace_commands(app, arguments, command);
  add_commissioning_commands(app, arguments, command);
  std::function<Result<>()> offline_command;
  add_offline_commands(app, arguments, offline_command, command);
  add_bus_commands(app, arguments, offline_command);
  gateway::take_finite_numbers_only(app);
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return report(app, error);
  }
  if (offline_command) {
    const auto done = offline_command();
    return done ? kExitDone : report(done.error());
  }
  auto connection = Connection::open(arguments.endpoint);
  if (!connection) return report(connection.error());
  const auto done = command(**connection);
  return done ? kExitDone : report(done.error());
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(count, words);
  } catch (const std::exception& error) {
    return report(Failure{error.what()});
  }
}
