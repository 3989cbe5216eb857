#include "gateway/buses/built_in_interfaces.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gateway/buses/device_descriptions.hpp"
#include "gateway/buses/drive_library_file.hpp"
#include "gateway/buses/register_map_file.hpp"
#include "gateway/buses/simulated_bus.hpp"
#include "gateway/buses/simulated_io.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/fieldbus/gpio/gpio_interface.hpp"
#include "rmac/fieldbus/modbus/io_interface.hpp"
#include "rmac/fieldbus/modbus/spindle_interface.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::gateway {
namespace {

Expected<std::shared_ptr<DigitalControlInterface>> make_simulated(const sdk::ModuleChoice& choice, double period_s) {
  const auto axes = simulated_axes(choice);
  if (!axes) return tl::unexpected(axes.error());
  const auto contact = simulated_contact(choice);
  if (!contact) return tl::unexpected(contact.error());
  const auto late = simulated_answer_delay(choice);
  if (!late) return tl::unexpected(late.error());
  auto made = std::make_shared<fieldbus::SimulatedInterface>(*axes, period_s);
  made->set_answer_delay(*late);
  if (*contact) made->set_contact(**contact);
  return made;
}

Expected<std::shared_ptr<DigitalControlInterface>> make_canopen(const std::string& bus, const sdk::ModuleChoice& choice,
                                                                const ModuleLoader& loader, double period_s,
                                                                const std::filesystem::path& drives_folder) {
  auto drives = std::make_shared<fieldbus::canopen::DriveLibrary>(read_drive_library(drives_folder));
  auto config = fieldbus::canopen::read_canopen_config(bus, choice.numbers, choice.texts, period_s,
                                                       find_descriptions(loader), std::move(drives));
  if (!config) return tl::unexpected(config.error());
  if (auto fits = fieldbus::canopen::check_bus_load(*config); !fits) return tl::unexpected(fits.error());
  return fieldbus::canopen::make_socketcan_interface(std::move(*config));
}

Expected<std::filesystem::path> find_register_map(const ModuleLoader& loader, const std::string& name) {
  return loader.find_file("modbus", name, ".json", "register map");
}

Expected<std::shared_ptr<DigitalControlInterface>> make_modbus(const std::string& bus, const sdk::ModuleChoice& choice,
                                                               const ModuleLoader& loader) {
  auto config = fieldbus::modbus::read_spindle_line(bus, choice.numbers, choice.texts, [&](const std::string& name) {
    return find_register_map(loader, name).and_then(read_spindle_map);
  });
  if (!config) return tl::unexpected(config.error());
  return std::make_shared<fieldbus::modbus::SpindleInterface>(std::move(*config));
}

Expected<std::shared_ptr<DigitalIoInterface>> make_modbus_io(const sdk::ModuleChoice& choice,
                                                             const ModuleLoader& loader) {
  auto config = fieldbus::modbus::read_io_line(choice.numbers, choice.texts, [&](const std::string& name) {
    return find_register_map(loader, name).and_then(read_io_map);
  });
  if (!config) return tl::unexpected(config.error());
  return std::make_shared<fieldbus::modbus::IoInterface>(std::move(*config));
}

Expected<std::shared_ptr<DigitalIoInterface>> make_gpio(const sdk::ModuleChoice& choice, const ModuleLoader&) {
  auto config = fieldbus::gpio::read_gpio_config(choice.numbers, choice.texts);
  if (!config) return tl::unexpected(config.error());
  return std::make_shared<fieldbus::gpio::GpioInterface>(std::move(*config), fieldbus::gpio::make_kernel_lines());
}

/// Each parameter is a valve: its output, the input that follows it, 1 where that is on while the output is off, and
/// the time between, in s.
Expected<std::shared_ptr<DigitalIoInterface>> make_simulated_valves(const sdk::ModuleChoice& choice, double period_s) {
  constexpr double kLastBit = 63, kLongest_s = 60;
  const auto whole = [](double value, double most) {
    return value == std::floor(value) && value >= 0 && value <= most;
  };
  std::vector<fieldbus::SimulatedValve> valves;
  for (const auto& [name, values] : choice.numbers) {
    const bool sound = values.size() == 4 && whole(values[0], kLastBit) && whole(values[1], kLastBit) &&
                       whole(values[2], 1) && values[3] >= 0 && values[3] <= kLongest_s;
    if (!sound) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("SimulatedValves: parameter {} must be four numbers: an output from 0 to {}, an input "
                                 "from 0 to {}, 0 or 1 (the input is on while the output is off), and 0 to {} s",
                                 name, kLastBit, kLastBit, kLongest_s));
    }
    valves.push_back({static_cast<int>(values[0]), static_cast<int>(values[1]), values[2] == 1, values[3]});
  }
  if (!choice.texts.empty()) {
    return failure(MinorCode::InvalidParameterValue, "SimulatedValves takes no parameter that is a text");
  }
  return std::make_shared<fieldbus::SimulatedIoInterface>(valves, period_s);
}

}  // namespace

void add_built_in_interfaces(BusRegistry& registry, double period_s, const std::filesystem::path& drives_folder) {
  registry.add_control_interface("SimulatedInterface",
                                 [period_s](const std::string&, const sdk::ModuleChoice& choice, const ModuleLoader&) {
                                   return make_simulated(choice, period_s);
                                 });
  registry.add_control_interface(
      "CANopenInterface",
      [period_s, drives_folder](const std::string& bus, const sdk::ModuleChoice& choice, const ModuleLoader& loader) {
        return make_canopen(bus, choice, loader, period_s, drives_folder);
      },
      BusRegistry::Unused::IsMadeAnew);
  registry.add_control_interface("ModbusInterface", make_modbus);
  registry.add_io_interface("GPIOInterface", make_gpio);
  registry.add_io_interface("ModbusIOInterface", make_modbus_io);
  registry.add_io_interface("SimulatedValves", [period_s](const sdk::ModuleChoice& choice, const ModuleLoader&) {
    return make_simulated_valves(choice, period_s);
  });
  registry.add_io_interface("SimulatedIOInterface", [](const sdk::ModuleChoice& choice, const ModuleLoader&) {
    return make_simulated_io(choice).map([](auto made) -> std::shared_ptr<DigitalIoInterface> { return made; });
  });
}

}  // namespace rmac::gateway
