#pragma once

#include <functional>
#include <map>

#include "rmac/fieldbus/modbus/line.hpp"
#include "rmac/fieldbus/modbus/register_map.hpp"

namespace rmac::fieldbus::modbus {

/// One spindle drive on a line.
struct SpindleConfig {
  int slave = 1;
  double rpm_per_hz = 60;  ///< of the spindle for one Hz of the drive's output: 60 / pole pairs × gear
  double maximum_hz = 0;   ///< the drive's largest output frequency, where its map counts in parts of it
  SpindleMap map;
};

/// One line with spindle drives.
struct SpindleLineConfig {
  LineConfig line;
  std::chrono::milliseconds stale{1000};  ///< age at which what was read counts for nothing
  std::chrono::milliseconds busy{3000};   ///< the same, while the drive answers that it is busy
  std::chrono::milliseconds boot_timeout{5000};
  std::vector<SpindleConfig> axes;
};

/// One line with a device for inputs and outputs.
struct IoLineConfig {
  LineConfig line;
  std::chrono::milliseconds stale{1000};
  std::chrono::milliseconds boot_timeout{5000};
  int slave = 1;
  IoMap map;
};

/// Parameters as `device.json` has them, and where the register maps come from that they name.
using Numbers = std::map<std::string, std::vector<double>>;
using Texts = std::map<std::string, std::string>;
template <typename Map>
using FindMap = std::function<Expected<Map>(const std::string& name)>;

/// Read the parameters of `ModbusInterface` and `ModbusIOInterface` (docs/modbus.md). A parameter named `bus.name` is
/// for the bus `bus` alone and wins over `name`. The error names the parameter, its value and what is allowed.
[[nodiscard]] Expected<SpindleLineConfig> read_spindle_line(const std::string& bus, const Numbers& numbers,
                                                            const Texts& texts, const FindMap<SpindleMap>& find_map);
[[nodiscard]] Expected<IoLineConfig> read_io_line(const Numbers& numbers, const Texts& texts,
                                                  const FindMap<IoMap>& find_map);

}  // namespace rmac::fieldbus::modbus
