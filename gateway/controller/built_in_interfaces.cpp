#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/configuration/register_map_file.hpp"
#include "gateway/controller/controller_impl.hpp"
#include "gateway/controller/device_descriptions.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/fieldbus/modbus/io_interface.hpp"
#include "rmac/fieldbus/modbus/spindle_interface.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/fieldbus/simulated_io_interface.hpp"

namespace rmac::gateway {
namespace {

constexpr double kMostSimulatedAxes = 64;

/// The example machines' axes, or as many as the parameter `axes` says: more of them are table axes.
Expected<std::shared_ptr<DigitalControlInterface>> make_simulated(const sdk::ModuleChoice& choice, double period_s) {
  std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes();
  for (const auto& [name, numbers] : choice.numbers) {
    const bool whole = numbers.size() == 1 && numbers[0] == std::floor(numbers[0]);
    if (name != "axes" || !whole || numbers[0] < 1 || numbers[0] > kMostSimulatedAxes) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("SimulatedInterface: parameter \"{}\" is not understood; it takes \"axes\", a whole "
                                 "number from 1 to {}",
                                 name, kMostSimulatedAxes));
    }
    axes.resize(static_cast<std::size_t>(numbers[0]), fieldbus::AxisPlantParameters{});
  }
  if (!choice.texts.empty()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("SimulatedInterface: parameter \"{}\" is not understood; it takes \"axes\" alone",
                               choice.texts.begin()->first));
  }
  return std::make_shared<fieldbus::SimulatedInterface>(std::move(axes), period_s);
}

Expected<std::shared_ptr<DigitalControlInterface>> make_canopen(const std::string& bus, const sdk::ModuleChoice& choice,
                                                                const ModuleLoader& loader, double period_s) {
  auto config =
      fieldbus::canopen::read_canopen_config(bus, choice.numbers, choice.texts, period_s, find_descriptions(loader));
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

Expected<std::shared_ptr<DigitalIoInterface>> make_simulated_io(const sdk::ModuleChoice& choice, const ModuleLoader&) {
  if (!choice.numbers.empty() || !choice.texts.empty()) {
    return failure(MinorCode::InvalidParameterValue, "SimulatedIOInterface takes no parameters");
  }
  return std::make_shared<fieldbus::SimulatedIoInterface>();
}

}  // namespace

void add_built_in_interfaces(BusRegistry& registry, double period_s) {
  registry.add_control_interface("SimulatedInterface",
                                 [period_s](const std::string&, const sdk::ModuleChoice& choice, const ModuleLoader&) {
                                   return make_simulated(choice, period_s);
                                 });
  registry.add_control_interface("CANopenInterface", [period_s](const std::string& bus, const sdk::ModuleChoice& choice,
                                                                const ModuleLoader& loader) {
    return make_canopen(bus, choice, loader, period_s);
  });
  registry.add_control_interface("ModbusInterface", make_modbus);
  registry.add_io_interface("ModbusIOInterface", make_modbus_io);
  registry.add_io_interface("SimulatedIOInterface", make_simulated_io);
}

}  // namespace rmac::gateway
