#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <set>

#include "gateway/simulators/console/line_input.hpp"
#include "gateway/simulators/vdrive/command.hpp"
#include "gateway/simulators/vdrive/sheet.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"

// rmac-vdrive: CiA 402 drives that are simulated, on a CAN interface (docs/vdrive.md).
namespace {

using namespace rmac;
using namespace rmac::vdrive;
using fieldbus::AxisPlantParameters;
using fieldbus::CanPort;

constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;

volatile std::sig_atomic_t ends = 0;

struct Arguments {
  std::string interface, sheet, commands;
  std::vector<int> nodes, spindles;
  std::vector<std::uint32_t> unconfigured;  ///< serial numbers
  std::vector<std::string> at;
  bool quiet = false, print_sheet = false;
};

/// A spindle with its drive: as heavy and as strong as that of the simulated bus, and without a screw.
AxisPlantParameters spindle_plant() {
  const fieldbus::SpindlePlantParameters spindle;
  AxisPlantParameters plant;
  plant.rated_torque_nm = plant.peak_torque_nm = spindle.max_torque_nm;
  plant.rotor_inertia_kg_m2 = spindle.inertia_kg_m2;
  plant.screw_inertia_kg_m2 = plant.table_mass_kg = 0;
  return plant;
}

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// Drives, their bus, and what happens to them.
class Program {
 public:
  Program(std::unique_ptr<CanPort> port, Nodes nodes, std::vector<Scheduled> schedule, std::optional<LineInput> input,
          bool quiet)
      : port_(std::move(port)),
        nodes_(std::move(nodes)),
        schedule_(std::move(schedule)),
        input_(std::move(input)),
        states_(nodes_.size(), -1),
        quiet_(quiet) {}

  void run() {
    const Time start = port_->now();
    for (auto& node : nodes_) node->power_on(start);
    while (ends == 0) {
      send();
      port_->wait(std::chrono::milliseconds(1));
      fieldbus::CanFrame frame;
      while (port_->receive(frame)) {
        for (auto& node : nodes_) node->receive(frame, port_->now());
        send();
      }
      for (auto& node : nodes_) node->poll(port_->now());
      act(port_->now() - start);
      tell_changes();
    }
  }

 private:
  void send() {
    const Time now = port_->now();
    for (auto& node : nodes_) {
      for (const fieldbus::CanFrame& out : node->take_output(now)) port_->send(out);
    }
  }

  void act(Time since_start) {
    while (!schedule_.empty() && schedule_.front().at <= since_start) {
      carry_out(schedule_.front().line);
      schedule_.erase(schedule_.begin());
    }
    while (input_) {
      const auto line = input_->next();
      if (!line) break;
      if (line->find_first_not_of(" \t\r") != std::string::npos) carry_out(*line);
    }
  }

  void carry_out(const std::string& line) {
    const auto answer = execute(line, nodes_, port_->now());
    say(answer ? *answer : "error: " + answer.error().message);
  }

  void tell_changes() {
    for (std::size_t i = 0; i < nodes_.size() && !quiet_; ++i) {
      const Axis& axis = nodes_[i]->axis();
      if (states_[i] == axis.state()) continue;
      states_[i] = axis.state();
      say(fmt::format("{:.6f} node {} {} at {:.0f}", std::chrono::duration<double>(port_->now()).count(),
                      nodes_[i]->id(), to_string(axis.state()), axis.position()));
    }
  }

  std::unique_ptr<CanPort> port_;
  Nodes nodes_;
  std::vector<Scheduled> schedule_;
  std::optional<LineInput> input_;
  std::vector<int> states_;
  bool quiet_;
};

/// A sheet that lacks what the drive lives by would make another device of it.
Expected<> check_complete(const fieldbus::eds::DeviceDescription& sheet) {
  const auto own = fieldbus::eds::parse_device_description(sheet_text(), "rmac-vdrive.eds");
  if (!own) return tl::unexpected(own.error());
  for (const auto& [address, entry] : own->entries) {
    const auto* found = sheet.find(address);
    if (found != nullptr && found->type == entry.type) continue;
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} ({}) is {}; change values only in what --print-eds gives", sheet.file,
                               to_string(address), entry.name, found == nullptr ? "missing" : "of another type"));
  }
  return {};
}

Expected<Nodes> make_nodes(const Arguments& arguments) {
  const auto sheet = arguments.sheet.empty() ? fieldbus::eds::parse_device_description(sheet_text(), "rmac-vdrive.eds")
                                             : fieldbus::eds::read_device_description(arguments.sheet);
  if (!sheet) return tl::unexpected(sheet.error());
  if (auto complete = check_complete(*sheet); !complete) return tl::unexpected(complete.error());
  Nodes nodes;
  std::set<int> taken;
  for (const auto* list : {&arguments.nodes, &arguments.spindles}) {
    for (const int id : *list) {
      if (!taken.insert(id).second) {
        return failure(MinorCode::InvalidParameterValue, fmt::format("node {} is given twice", id));
      }
      const AxisPlantParameters plant = list == &arguments.spindles ? spindle_plant() : AxisPlantParameters();
      nodes.push_back(std::make_unique<Node>(*sheet, static_cast<std::uint8_t>(id), plant));
    }
  }
  for (const std::uint32_t serial : arguments.unconfigured) {
    nodes.push_back(std::make_unique<Node>(*sheet, LssSlave::kUnconfigured, AxisPlantParameters(), serial));
  }
  return nodes;
}

Expected<> run(const Arguments& arguments) {
  std::vector<Scheduled> schedule;
  for (const std::string& text : arguments.at) {
    auto read = read_scheduled(text);
    if (!read) return tl::unexpected(read.error());
    schedule.push_back(std::move(*read));
  }
  std::stable_sort(schedule.begin(), schedule.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  auto nodes = make_nodes(arguments);
  if (!nodes) return tl::unexpected(nodes.error());
  std::optional<LineInput> input;
  if (!arguments.commands.empty()) {
    auto opened = LineInput::open(arguments.commands);
    if (!opened) return tl::unexpected(opened.error());
    input.emplace(std::move(*opened));
  }
  // A node may answer an SDO block with 127 frames at once.
  constexpr std::size_t kBurst = 10;
  auto port = fieldbus::SocketCanPort::open(arguments.interface, {}, kBurst);
  if (!port) return tl::unexpected(port.error());
  for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, [](int) { ends = 1; });
  Program(std::move(*port), std::move(*nodes), std::move(schedule), std::move(input), arguments.quiet).run();
  return {};
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app{"rmac-vdrive serves CiA 402 drives that are simulated on a CAN interface, until a signal ends it.",
               "rmac-vdrive"};
  app.set_version_flag("--version", RMAC_VERSION);
  app.add_flag("--print-eds", arguments.print_sheet, "print the drives' data sheet and end");
  app.add_option("INTERFACE", arguments.interface, "a CAN interface that is up: vcan0, can0");
  app.add_option("NODE", arguments.nodes, "node ids of servo axes, 1 to 127")->check(CLI::Range(1, 127));
  app.add_option("--spindle", arguments.spindles, "node ids of spindles")->check(CLI::Range(1, 127));
  app.add_option("--unconfigured", arguments.unconfigured,
                 "serial numbers of servo axes without a node id, which LSS gives them");
  app.add_option("--eds", arguments.sheet, "another data sheet, or a DCF, with the same objects and other values");
  app.add_option("--at", arguments.at, "\"SECONDS COMMAND\": a command some time after the start")
      ->allow_extra_args(false);
  app.add_option("--commands", arguments.commands, "read commands from this FIFO, or - for standard input");
  app.add_flag("--quiet", arguments.quiet, "do not print changes of the power states");
  app.footer(std::string("Commands:\n") + std::string(command_help()));
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (arguments.print_sheet) {
    fmt::print("{}", sheet_text());
    return 0;
  }
  if (arguments.interface.empty() ||
      arguments.nodes.size() + arguments.spindles.size() + arguments.unconfigured.size() == 0) {
    fmt::print(stderr, "rmac-vdrive: an interface and at least one node are needed: rmac-vdrive vcan0 1 2 3\n");
    return kExitUsage;
  }
  if (const auto done = run(arguments); !done) {
    fmt::print(stderr, "rmac-vdrive: {}\n", done.error().message);
    return kExitFailed;
  }
  return 0;
}
