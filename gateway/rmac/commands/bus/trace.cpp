#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <set>

#include "gateway/rmac/commands/bus/machine_bus.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/commands/bus/trace_output.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"

namespace rmac::cli {
namespace {

using fieldbus::canopen::CanopenConfig;

struct TraceOptions {
  std::string interface, file, record;
  MachineChoice machine;
  TraceView view;
  double seconds = 0;  ///< 0: until it is ended
};

/// Where a trace is recorded; a file that is there already is left alone.
class Recorder {
 public:
  static Result<Recorder> open(const std::string& file) {
    Recorder recorder(file);
    if (file.empty()) return recorder;
    recorder.stream_.reset(std::fopen(file.c_str(), "wx"));  // x: the file is new
    if (!recorder.stream_) return fail(fmt::format("{}: {}", file, std::strerror(errno)));
    return recorder;
  }
  void write(const fieldbus::LoggedFrame& logged) {
    if (stream_) fmt::print(stream_.get(), "{}\n", to_log_line(logged));
  }
  Result<> flush() {
    if (!stream_ || std::fflush(stream_.get()) == 0) return {};
    return fail(fmt::format("{}: {}", file_, std::strerror(errno)));
  }

 private:
  struct Closer {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  explicit Recorder(std::string file) : file_(std::move(file)) {}

  std::string file_;
  std::unique_ptr<std::FILE, Closer> stream_;
};

/// Says what the kernel dropped because this program was too slow, when it becomes more.
void tell_lost(const std::string& interface, std::uint64_t lost, std::uint64_t& told) {
  if (lost == told) return;
  fmt::print(stderr, "rmac: {}: {} frames are lost so far, for they were not fetched in time\n", interface, lost);
  told = lost;
}

Result<> trace_bus(const TraceOptions& options, const std::vector<CanopenConfig>& buses) {
  const std::string& interface = options.interface;
  auto port = fieldbus::SocketCanPort::open(interface, {}, 0);
  if (!port) return fail(port.error().message);
  auto recorder = Recorder::open(options.record);
  if (!recorder) return tl::unexpected(recorder.error());
  TraceOutput output(buses, options.view);
  const auto end = (*port)->now() + std::chrono::milliseconds(std::llround(options.seconds * 1000));
  std::uint64_t told_lost = 0;
  while (options.seconds == 0 || (*port)->now() < end) {
    (*port)->wait(std::chrono::milliseconds(20));
    fieldbus::LoggedFrame logged;
    logged.interface = interface;
    while ((*port)->receive(logged.frame)) {
      recorder->write(logged);
      output.show(logged);
    }
    std::fflush(stdout);
    if (auto kept = recorder->flush(); !kept) return kept;
    const fieldbus::CanHealth health = (*port)->health();
    tell_lost(interface, health.overflowed, told_lost);
    if (health.link_down) return fail(fmt::format("{}: the interface went down", interface));
  }
  return {};
}

/// Of lines that came from a file.
class Reading {
 public:
  Reading(std::string file, std::string interface) : file_(std::move(file)), interface_(std::move(interface)) {}

  /// A frame that is to be shown, if the line is one.
  std::optional<fieldbus::LoggedFrame> take(const std::string& line) {
    ++lines_;
    auto logged = fieldbus::read_log_line(line);
    if (!logged) {
      if (line.find_first_not_of(" \t\r") != std::string::npos && strange_++ == 0) first_strange_ = lines_;
      return {};
    }
    interfaces_.insert(logged->interface);
    if (!interface_.empty() && logged->interface != interface_) return {};
    ++shown_;
    return logged;
  }
  /// Tells what was passed over; fails where nothing was there to be seen.
  [[nodiscard]] Result<> finish() const {
    if (strange_ > 0) {
      fmt::print(stderr, "rmac: {}:{}: no whole frame of candump's; {} line{} passed over\n", file_, first_strange_,
                 strange_, strange_ == 1 ? " is" : "s are");
    }
    if (shown_ > 0) return {};
    if (interfaces_.empty()) return fail(fmt::format("{}: there is no frame in it", file_));
    return fail(
        fmt::format("{}: there is no frame of {} in it, but of {}", file_, interface_, fmt::join(interfaces_, ", ")));
  }

 private:
  std::string file_, interface_;
  std::size_t lines_ = 0, strange_ = 0, first_strange_ = 0, shown_ = 0;
  std::set<std::string> interfaces_;
};

Result<> trace_file(const TraceOptions& options, const std::vector<CanopenConfig>& buses) {
  const bool from_input = options.file == "-";
  std::ifstream file;
  if (!from_input) {
    file.open(options.file);
    if (!file || std::filesystem::is_directory(options.file)) {
      return fail(fmt::format("{}: the file cannot be read", options.file));
    }
  }
  TraceOutput output(buses, options.view);
  Reading reading(options.file, options.interface);
  std::istream& stream = from_input ? std::cin : file;
  for (std::string line; std::getline(stream, line);) {
    if (const auto logged = reading.take(line)) output.show(*logged);
  }
  return reading.finish();
}

Result<> trace(TraceOptions options, bool json) {
  options.view.json = json;
  if (options.interface.empty() && options.file.empty()) {
    return fail("name the interface to listen to, or the --file to read");
  }
  std::vector<CanopenConfig> buses;
  if (!options.machine.machine.empty()) {
    auto read = canopen_buses(options.machine);
    if (!read) return tl::unexpected(read.error());
    buses = std::move(*read);
    if (!options.interface.empty() && bus_of_interface(buses, options.interface) == nullptr) {
      return fail(fmt::format("{} has no CAN bus {}", options.machine.machine, options.interface));
    }
  }
  return options.file.empty() ? trace_bus(options, buses) : trace_file(options, buses);
}

}  // namespace

void add_bus_trace(Command& bus) {
  const auto options = std::make_shared<TraceOptions>();
  Command traces = bus.add("trace", "tell what passes on a bus, in words; sends nothing, while a machine runs, too");
  traces.option("INTERFACE", &options->interface,
                "a CAN interface that is up; of a file, the one whose frames to show");
  add_machine_options(traces, options->machine);
  traces.option("--file", &options->file, "read what candump wrote, or --record; - for standard input");
  traces.option("--record", &options->record, "write each frame to this new file, as candump -l does")
      .excludes({"--file"});
  traces.option("--node", &options->view.node, "show frames of this node alone, and those of all").within(1, 127);
  traces.flag("--no-cyclic", &options->view.without_cyclic, "leave out SYNC and PDOs");
  traces.option("--seconds", &options->seconds, "end after so long; otherwise by Ctrl-C")
      .excludes({"--file"})
      .within(0.001, 1e6);
  traces.does(without_appliance([options](bool json) { return trace(*options, json); }));
}

}  // namespace rmac::cli
