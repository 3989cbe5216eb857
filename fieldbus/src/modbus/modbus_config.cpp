#include "rmac/fieldbus/modbus/modbus_config.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "modbus/open_line.hpp"
#include "parameters.hpp"

namespace rmac::fieldbus::modbus {
namespace {

constexpr double kMostMilliseconds = 60'000;

std::chrono::milliseconds milliseconds(double count) {
  return std::chrono::milliseconds(std::llround(count));
}

/// Where the line is: `address` says TCP, `device` a serial port.
Endpoint read_endpoint(Parameters& parameters) {
  const std::string address = parameters.text("address", "");
  const std::string device = parameters.text("device", "");
  const auto port = static_cast<std::uint16_t>(parameters.number("tcp_port", 502, 1, 65535));
  const auto bit_rate = static_cast<int>(parameters.number("bit_rate", 9600, 1200, 921600));
  const auto stop_bits = static_cast<int>(parameters.number("stop_bits", 1, 1, 2));
  const std::string parity = parameters.text("parity", "N");
  if (address.empty() == device.empty()) {
    parameters.refuse(
        "either \"address\" (the IP address of a TCP device) or \"device\" (a serial port, for example /dev/ttyUSB0) "
        "must be given");
  }
  if (parity.size() != 1) parameters.refuse(fmt::format("parity is \"{}\"; there are N, E and O", parity));
  if (!parameters.sound()) return {};
  Endpoint endpoint = address.empty() ? Endpoint(RtuEndpoint{device, bit_rate, parity[0], stop_bits})
                                      : Endpoint(TcpEndpoint{address, port});
  parameters.refuse(check(endpoint));
  return endpoint;
}

template <typename Config>
void read_line(Parameters& parameters, Config& config) {
  config.line.endpoint = read_endpoint(parameters);
  config.line.deadline = milliseconds(parameters.number("deadline_ms", 200, 5, kMostMilliseconds));
  config.line.period = milliseconds(parameters.number("period_ms", 50, 1, kMostMilliseconds));
  config.stale = milliseconds(parameters.number("stale_ms", 1000, 10, kMostMilliseconds));
  config.boot_timeout = milliseconds(1000 * parameters.number("boot_timeout_s", 5, 0.1, 600, Parameters::Kind::Any));
  const auto least = config.line.period + config.line.deadline;
  if (config.stale <= least) {
    parameters.refuse(
        fmt::format("stale_ms is {}; it must be above period_ms and deadline_ms together, {}, or values "
                    "would be stale before newer ones can come",
                    config.stale.count(), least.count()));
  }
}

int read_slave(Parameters& parameters, std::size_t axis, const Endpoint& endpoint) {
  const int slave = static_cast<int>(parameters.number_of_axis("slave", axis, 1, 1, 255));
  const bool unit = slave <= 247 || (slave == 255 && std::holds_alternative<TcpEndpoint>(endpoint));
  if (!unit) parameters.refuse(fmt::format("slave is {}; slaves are 1 to 247", slave));
  return slave;
}

tl::unexpected<Error> problem(const Parameters& parameters) {
  return failure(MinorCode::InvalidParameterValue, parameters.problem());
}

Expected<SpindleConfig> read_axis(Parameters& parameters, std::size_t axis, const Endpoint& endpoint,
                                  const FindMap<SpindleMap>& find_map) {
  SpindleConfig config;
  config.slave = read_slave(parameters, axis, endpoint);
  config.rpm_per_hz = parameters.number_of_axis("rpm_per_hz", axis, 60, 1e-3, 1e5, Parameters::Kind::Any);
  config.maximum_hz = parameters.number_of_axis("maximum_hz", axis, 0, 0, 1e5, Parameters::Kind::Any);
  const std::string name = parameters.text_of_axis("map", axis, "");
  if (name.empty()) parameters.refuse("map is missing; it names the register map of the drive");
  if (!parameters.sound()) return problem(parameters);
  auto map = find_map(name);
  if (!map) return failure(map.error().code, parameters.place("map: " + map.error().message));
  config.map = std::move(*map);
  if (config.map.speed_command_unit == SpindleMap::Unit::OfMaximum && !(config.maximum_hz > 0)) {
    parameters.refuse(
        fmt::format("maximum_hz is missing; {} takes its speed in parts of the largest frequency that is "
                    "set in the drive",
                    name));
    return problem(parameters);
  }
  return config;
}

}  // namespace

Expected<SpindleLineConfig> read_spindle_line(const std::string& bus, const Numbers& numbers, const Texts& texts,
                                              const FindMap<SpindleMap>& find_map) {
  Parameters parameters("ModbusInterface", "slave", bus, numbers, texts);
  SpindleLineConfig config;
  read_line(parameters, config);
  config.busy = milliseconds(parameters.number("busy_ms", 3000, 0, kMostMilliseconds));
  const std::size_t axes = parameters.axes();
  if (axes == 0) parameters.refuse("slave is missing; it lists the slave number of each axis, for example [1]");
  std::set<int> slaves;
  for (std::size_t axis = 0; axis < axes && parameters.sound(); ++axis) {
    auto read = read_axis(parameters, axis, config.line.endpoint, find_map);
    if (!read) return tl::unexpected(read.error());
    if (!slaves.insert(read->slave).second) {
      parameters.refuse(fmt::format("slave {} stands twice; each drive needs a number of its own", read->slave));
    }
    config.axes.push_back(std::move(*read));
  }
  parameters.refuse_unknown();
  if (!parameters.sound()) return problem(parameters);
  return config;
}

Expected<IoLineConfig> read_io_line(const Numbers& numbers, const Texts& texts, const FindMap<IoMap>& find_map) {
  Parameters parameters("ModbusIOInterface", "slave", "", numbers, texts);
  IoLineConfig config;
  read_line(parameters, config);
  config.slave = read_slave(parameters, 0, config.line.endpoint);
  if (parameters.axes() > 1) parameters.refuse("slave has several values; it takes one");
  const std::string name = parameters.text("map", "");
  if (name.empty()) parameters.refuse("map is missing; it names the register map of the device");
  parameters.refuse_unknown();
  if (!parameters.sound()) return problem(parameters);
  auto map = find_map(name);
  if (!map) return failure(map.error().code, parameters.place("map: " + map.error().message));
  config.map = std::move(*map);
  return config;
}

}  // namespace rmac::fieldbus::modbus
