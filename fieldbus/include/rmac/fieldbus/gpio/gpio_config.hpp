#pragma once

#include <map>
#include <vector>

#include "rmac/fieldbus/gpio/line_port.hpp"

namespace rmac::fieldbus::gpio {

struct InputConfig {
  std::size_t bit = 0;             ///< of the I/O port
  std::vector<LineSpec> contacts;  ///< 1 or 2
  Time debounce{};
};

struct OutputConfig {
  std::size_t bit = 0;
  LineSpec line;
};

struct GpioConfig {
  std::vector<InputConfig> inputs;
  std::vector<OutputConfig> outputs;
  Time disagreement{};  ///< that the two contacts of an input may show while they switch
};

/// Reads the parameters of `GPIOInterface` (docs/gpio.md). Errors name the parameter.
[[nodiscard]] Expected<GpioConfig> read_gpio_config(const std::map<std::string, std::vector<double>>& numbers,
                                                    const std::map<std::string, std::string>& texts);

}  // namespace rmac::fieldbus::gpio
