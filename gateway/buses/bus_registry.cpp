#include "gateway/buses/bus_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "gateway/buses/bus_choice.hpp"
#include "rmac/fieldbus/fault_texts.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"
#include "rmac/sdk/buses_of.hpp"

namespace rmac::gateway {
namespace {

/// Has axes to name, and nothing behind them.
class NoBus final : public DigitalControlInterface {
 public:
  std::size_t axis_count() const noexcept override { return kAxes; }
  Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool receive(std::span<DriveFeedback>) noexcept override { return true; }
  bool send(std::span<const DriveCommand>) noexcept override { return true; }

 private:
  static constexpr std::size_t kAxes = 256;
};

tl::unexpected<Error> no_interface(const char* what, const sdk::ModuleChoice& choice, const std::string& built_in,
                                   const Error& loading) {
  return failure(loading.code, fmt::format("no {} \"{}\": built in are {}; as a module: {}", what, choice.name,
                                           built_in, loading.message));
}

template <typename Map>
std::string names(const Map& map) {
  std::string text;
  for (const auto& [name, ignored] : map) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace

void BusRegistry::add_control_interface(const std::string& name, ControlFactory factory, Unused unused) {
  control_factories_[name] = std::move(factory);
  if (unused == Unused::IsMadeAnew) made_anew_.insert(name);
}

void BusRegistry::add_io_interface(const std::string& name, IoFactory factory) {
  io_factories_[name] = std::move(factory);
}

Expected<std::shared_ptr<DigitalControlInterface>> BusRegistry::make_control(const std::string& bus,
                                                                             const sdk::ModuleChoice& choice,
                                                                             const ModuleLoader& loader) const {
  if (const auto built_in = control_factories_.find(choice.name); built_in != control_factories_.end()) {
    return built_in->second(bus, choice, loader);
  }
  auto loaded = loader.load<DigitalControlInterface>(choice);
  if (!loaded) {
    return no_interface("digital control interface", choice, names(control_factories_), loaded.error());
  }
  return std::move(loaded->object);
}

Expected<std::shared_ptr<DigitalIoInterface>> BusRegistry::make_io(const sdk::ModuleChoice& choice,
                                                                   const ModuleLoader& loader) const {
  if (const auto built_in = io_factories_.find(choice.name); built_in != io_factories_.end()) {
    return built_in->second(choice, loader);
  }
  auto loaded = loader.load<DigitalIoInterface>(choice);
  if (!loaded) return no_interface("digital I/O interface", choice, names(io_factories_), loaded.error());
  return std::move(loaded->object);
}

Expected<> BusRegistry::check_control_interface(const sdk::ModuleChoice& choice, const ModuleLoader& loader) const {
  if (control_factories_.contains(choice.name)) return {};
  return make_control("", interface_of_bus("", choice), loader).map([](const auto&) {});
}

Expected<> BusRegistry::check_io_interface(const sdk::ModuleChoice& choice, const ModuleLoader& loader) const {
  return make_io(choice, loader).map([](const auto&) {});
}

void BusRegistry::forget_outdated(const std::string& name) {
  const auto known = buses_.find(name);
  if (known == buses_.end() || known->second.started || known->second.bus.use_count() > 1) return;
  if (made_anew_.contains(known->second.choice.name)) buses_.erase(known);
}

Expected<std::shared_ptr<ServoBus>> BusRegistry::acquire(const std::string& name, const sdk::ModuleChoice& choice,
                                                         const ModuleLoader& loader) {
  forget_outdated(name);
  auto known = buses_.find(name);
  if (known != buses_.end() && known->second.choice != choice) {
    if (known->second.bus.use_count() > 1) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("bus {} is run by {} for the mechanism in force; unload that before the bus is given "
                                 "to {} or to other parameters",
                                 name, known->second.choice.name, choice.name));
    }
    if (known->second.started) known->second.bus->interface->stop();
    buses_.erase(known);
    known = buses_.end();
  }
  if (known == buses_.end()) {
    auto made = make_control(name, choice, loader);
    if (!made) return tl::unexpected(made.error());
    known = buses_.emplace(name, Bus{choice, std::make_shared<ServoBus>(std::move(*made)), false}).first;
  }
  Bus& bus = known->second;
  if (!bus.started) {
    if (auto started = bus.bus->interface->start(); !started) {
      return failure(started.error().code, fmt::format("bus {} did not come up: {}", name, started.error().message));
    }
    bus.started = true;
    const auto* told = dynamic_cast<const fieldbus::StartNotes*>(bus.bus->interface.get());
    for (const std::string& note : told != nullptr ? told->start_notes() : std::vector<std::string>()) {
      spdlog::warn("bus {}: {}", name, note);
    }
  }
  return bus.bus;
}

fieldbus::FieldbusReport BusRegistry::reports() const {
  fieldbus::FieldbusReport told;
  const auto add_line = [&told](const auto& interface) {
    const auto* line = dynamic_cast<const fieldbus::modbus::LineReports*>(&interface);
    if (line != nullptr) told.modbus.push_back(line->line_report());
  };
  for (const auto& [name, bus] : buses_) {
    if (!bus.started) continue;
    const auto* watches = dynamic_cast<const fieldbus::BusReports*>(bus.bus->interface.get());
    if (watches != nullptr) told.can.push_back(watches->report());
    add_line(*bus.bus->interface);
  }
  for (const auto& [name, io] : ios_) {
    if (io.started) add_line(*io.interface);
  }
  return told;
}

bool BusRegistry::runs_otherwise(const sdk::DeviceObject& device) const {
  const auto other = [&](const std::string& name) {
    const auto known = buses_.find(name);
    return known != buses_.end() && known->second.bus.use_count() > 1 &&
           known->second.choice != interface_of_bus(name, device.digital_control_interface);
  };
  if (std::ranges::any_of(sdk::buses_of(device), other)) return true;
  const auto io = ios_.find(device.digital_io_interface.name);
  return io != ios_.end() && io->second.interface.use_count() > 1 && io->second.choice != device.digital_io_interface;
}

std::shared_ptr<ServoBus> BusRegistry::virtual_bus(const std::string& name) {
  std::shared_ptr<ServoBus>& bus = virtual_buses_[name];
  if (!bus) bus = std::make_shared<ServoBus>(std::make_shared<NoBus>());
  return bus;
}

Expected<std::shared_ptr<DigitalIoInterface>> BusRegistry::acquire_io(const sdk::ModuleChoice& choice,
                                                                      const ModuleLoader& loader) {
  auto known = ios_.find(choice.name);
  if (known != ios_.end() && known->second.choice != choice) {
    if (known->second.interface.use_count() > 1) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("{} is in use by the mechanism in force; unload that before it gets other parameters",
                                 choice.name));
    }
    if (known->second.started) known->second.interface->stop();
    ios_.erase(known);
    known = ios_.end();
  }
  if (known == ios_.end()) {
    auto made = make_io(choice, loader);
    if (!made) return tl::unexpected(made.error());
    known = ios_.emplace(choice.name, Io{choice, std::move(*made), false}).first;
  }
  Io& io = known->second;
  if (!io.started) {
    if (auto started = io.interface->start(); !started) return tl::unexpected(started.error());
    io.started = true;
  }
  return io.interface;
}

void BusRegistry::stop_unused() noexcept {
  for (auto& [name, bus] : buses_) {
    if (bus.started && bus.bus.use_count() == 1) {
      bus.bus->interface->stop();
      bus.started = false;
    }
  }
  for (auto& [name, io] : ios_) {
    if (io.started && io.interface.use_count() == 1) {
      io.interface->stop();
      io.started = false;
    }
  }
}

}  // namespace rmac::gateway
