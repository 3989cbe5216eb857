#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "gateway/configuration/configuration.hpp"
#include "gateway/json/finite_numbers.hpp"
#include "gateway/simulators/console/line_input.hpp"
#include "gateway/simulators/vdrive/command.hpp"
#include "gateway/simulators/vmodbus/endpoints.hpp"

// rmac-vmodbus: spindle drives and remote I/O that are simulated, on Modbus (docs/vmodbus.md).
namespace {

using namespace rmac;
using namespace rmac::vmodbus;

constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;
constexpr const char* kCommands =
    "Commands, a slave number or \"all\" before each:\n"
    "  mute on|off       hears and acts, and answers nothing\n"
    "  wrong-id on|off   answers as another slave\n"
    "  noise on|off      answers with bytes that are no frame\n"
    "  busy on|off       refuses all with exception 6\n"
    "  late MS           each answer so much later; 0 ends it\n"
    "  drip MS           so much between two bytes; 0 ends it\n"
    "  power off|on      off, and on again with nothing kept\n"
    "  trip CODE         a spindle drive trips\n"
    "  panel-stop        someone stops a spindle drive at its panel\n"
    "  input BIT on|off  an input of remote I/O\n"
    "  status            tells what it does now\n";

volatile std::sig_atomic_t ends = 0;

struct Arguments {
  std::vector<std::string> devices, at, pseudo_terminals;
  std::string address = "127.0.0.1", commands;
  int tcp_port = -1;
  SerialSettings serial;
  SpindleOptions spindle;
  bool quiet = false;
};

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

tl::unexpected<Error> refuse(const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, what);
}

/// A map by its name among those that are shipped, or a file.
Expected<std::string> find_map(const std::string& name) {
  const std::filesystem::path folder = gateway::default_folders().device_tree / "modules" / "modbus";
  const std::filesystem::path shipped = folder / (name + ".json");
  std::error_code ignored;
  if (std::filesystem::exists(shipped, ignored)) return shipped.string();
  if (std::filesystem::is_regular_file(name, ignored)) return name;
  return refuse(fmt::format("\"{}\" is neither a register map in {} nor a file", name, folder.string()));
}

/// "3=delta-vfd-b", or the map alone for slave 1.
Expected<> add_device(const std::string& text, const SpindleOptions& options, Devices& devices) {
  const std::size_t equals = text.find('=');
  int slave = 1;
  if (equals != std::string::npos) {
    const auto [end, trouble] = std::from_chars(text.data(), text.data() + equals, slave);
    if (trouble != std::errc() || end != text.data() + equals || slave < 1 || slave > 247) {
      return refuse(fmt::format("\"{}\": slaves are 1 to 247; write 3=delta-vfd-b", text));
    }
  }
  auto device =
      find_map(equals == std::string::npos ? text : text.substr(equals + 1)).and_then([&](const std::string& map) {
        return make_device(map, options);
      });
  if (!device) return tl::unexpected(device.error());
  if (!devices.emplace(slave, std::move(*device)).second) return refuse(fmt::format("slave {} is given twice", slave));
  return {};
}

Expected<std::string> set_manner(Device& device, const std::string& verb, const std::string& value) {
  Manners& manners = device.manners;
  const std::map<std::string, bool*> switches{
      {"mute", &manners.mute}, {"wrong-id", &manners.wrong_id}, {"noise", &manners.noise}, {"busy", &manners.busy}};
  if (const auto found = switches.find(verb); found != switches.end()) {
    if (value != "on" && value != "off") return refuse(fmt::format("\"{}\" is neither on nor off", value));
    *found->second = value == "on";
    return "ok";
  }
  if (verb == "power") {
    if (value != "on" && value != "off") return refuse(fmt::format("\"{}\" is neither on nor off", value));
    manners.mute = value == "off";
    device.reset();
    return "ok";
  }
  double ms = -1;
  const auto [end, trouble] = std::from_chars(value.data(), value.data() + value.size(), ms);
  constexpr double kMost = 60'000;
  if (trouble != std::errc() || end != value.data() + value.size() || !(ms >= 0 && ms <= kMost)) {
    return refuse(fmt::format("\"{}\" is no time from 0 to {:g} ms", value, kMost));
  }
  (verb == "late" ? manners.late_s : manners.drip_s) = ms / 1000;
  return "ok";
}

Expected<std::string> execute_on(Device& device, const std::string& verb, const std::string& value) {
  if (verb == "status") return device.status();
  for (const char* manner : {"mute", "wrong-id", "noise", "busy", "late", "drip", "power"}) {
    if (verb == manner) return set_manner(device, verb, value);
  }
  return device.execute(verb, value);
}

/// "1 mute on"
Expected<std::string> execute(const std::string& line, Devices& devices) {
  std::istringstream words(line);
  std::string who, verb, value;
  words >> who >> verb;
  std::getline(words >> std::ws, value);
  std::string answers;
  for (auto& [slave, device] : devices) {
    if (who != "all" && who != std::to_string(slave)) continue;
    auto answer = execute_on(*device, verb, value);
    if (!answer) return answer;
    answers += fmt::format("{}slave {}: {}", answers.empty() ? "" : "\n", slave, *answer);
  }
  if (answers.empty()) return refuse(fmt::format("\"{}\" is no slave here; write \"1 mute on\"", line));
  return answers;
}

/// Devices, their lines, and what happens to them.
void run(Devices& devices, Endpoints& endpoints, std::vector<vdrive::Scheduled> schedule,
         std::optional<vdrive::LineInput> input, bool quiet) {
  const auto carry_out = [&](const std::string& line) {
    const auto answer = execute(line, devices);
    say(answer ? *answer : "error: " + answer.error().message);
  };
  const auto start = Clock::now();
  auto before = start;
  while (ends == 0) {
    endpoints.serve(std::chrono::milliseconds(5));
    const auto now = Clock::now();
    for (auto& [slave, device] : devices) {
      const bool news = device->advance(std::chrono::duration<double>(now - before).count());
      if (news && !quiet) say(fmt::format("slave {} {}", slave, device->status()));
    }
    before = now;
    while (!schedule.empty() && schedule.front().at <= now - start) {
      carry_out(schedule.front().line);
      schedule.erase(schedule.begin());
    }
    while (input) {
      const auto line = input->next();
      if (!line) break;
      if (line->find_first_not_of(" \t\r") != std::string::npos) carry_out(*line);
    }
  }
}

Expected<> serve(const Arguments& arguments) {
  Devices devices;
  for (const std::string& text : arguments.devices) {
    if (auto added = add_device(text, arguments.spindle, devices); !added) return added;
  }
  std::vector<vdrive::Scheduled> schedule;
  for (const std::string& text : arguments.at) {
    auto read = vdrive::read_scheduled(text);
    if (!read) return tl::unexpected(read.error());
    schedule.push_back(std::move(*read));
  }
  std::stable_sort(schedule.begin(), schedule.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  std::optional<vdrive::LineInput> input;
  if (!arguments.commands.empty()) {
    auto opened = vdrive::LineInput::open(arguments.commands);
    if (!opened) return tl::unexpected(opened.error());
    input.emplace(std::move(*opened));
  }
  Endpoints endpoints(devices);
  if (arguments.tcp_port >= 0) {
    const auto port = endpoints.listen(arguments.address, arguments.tcp_port);
    if (!port) return tl::unexpected(port.error());
    say(fmt::format("listening on {}:{}", arguments.address, *port));
  }
  for (const std::string& path : arguments.pseudo_terminals) {
    if (auto opened = endpoints.open_pseudo_terminal(path); !opened) return opened;
    say(fmt::format("serial port {}", path));
  }
  if (!arguments.serial.device.empty()) {
    if (auto opened = endpoints.open_serial(arguments.serial); !opened) return opened;
  }
  for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, [](int) { ends = 1; });
  std::signal(SIGPIPE, SIG_IGN);
  run(devices, endpoints, std::move(schedule), std::move(input), arguments.quiet);
  return {};
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app{
      "rmac-vmodbus serves spindle drives and remote I/O that are simulated on Modbus, until a signal ends it.",
      "rmac-vmodbus"};
  app.set_version_flag("--version", RMAC_VERSION);
  app.add_option("DEVICE", arguments.devices,
                 "SLAVE=MAP: a slave number and a register map, by its name or its file; a map alone is slave 1")
      ->required();
  app.add_option("--tcp", arguments.tcp_port, "TCP port to listen on; 0: one that is free")
      ->check(CLI::Range(0, 65535));
  app.add_option("--address", arguments.address, "address to listen on")->capture_default_str();
  app.add_option("--pty", arguments.pseudo_terminals,
                 "make a pseudo-terminal and this link to it: a serial port for RTU")
      ->allow_extra_args(false);
  app.add_option("--serial", arguments.serial.device, "serial port for RTU");
  app.add_option("--bit-rate", arguments.serial.bit_rate, "of the serial port")->capture_default_str();
  app.add_option("--parity", arguments.serial.parity, "N, E or O")
      ->check(CLI::IsMember({'N', 'E', 'O'}))
      ->capture_default_str();
  app.add_option("--stop-bits", arguments.serial.stop_bits, "1 or 2")->check(CLI::Range(1, 2))->capture_default_str();
  app.add_option("--maximum-hz", arguments.spindle.maximum_hz, "largest frequency, for maps that command parts of it")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--ramp", arguments.spindle.ramp_hz_s, "Hz a second by which spindles change")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--time-out", arguments.spindle.time_out_s,
                 "seconds without a request after which a spindle drive that runs ramps down; 0: never")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--time-out-trip", arguments.spindle.time_out_code,
                 "the code with which it trips instead, and coasts; 0: it ramps down")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--at", arguments.at, "\"SECONDS COMMAND\": a command some time after the start")
      ->allow_extra_args(false);
  app.add_option("--commands", arguments.commands, "read commands from this FIFO, or - for standard input");
  app.add_flag("--quiet", arguments.quiet, "do not print what changes");
  app.footer(kCommands);
  gateway::take_finite_numbers_only(app);
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (arguments.tcp_port < 0 && arguments.pseudo_terminals.empty() && arguments.serial.device.empty()) {
    fmt::print(stderr, "rmac-vmodbus: a line is needed: --tcp PORT, --pty LINK or --serial DEVICE\n");
    return kExitUsage;
  }
  if (const auto done = serve(arguments); !done) {
    fmt::print(stderr, "rmac-vmodbus: {}\n", done.error().message);
    return kExitFailed;
  }
  return 0;
}
