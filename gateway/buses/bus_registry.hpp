#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "gateway/modules/module_loader.hpp"
#include "rmac/fieldbus/bus_report.hpp"
#include "rmac/motion/servo/servo_bus.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The buses of the appliance. They outlive mechanisms, which borrow axes of them: a drive that two mechanisms share
/// stays operational while one replaces the other. Interfaces are built in and chosen by name, or come as modules.
/// Gateway thread only.
class BusRegistry {
 public:
  /// Makes the interface to one bus, which `device.json` names. The name may say which of the machine's interfaces it
  /// is; the loader finds what else it needs in the mechanism's folder and the shared ones.
  using ControlFactory = std::function<Expected<std::shared_ptr<DigitalControlInterface>>(
      const std::string& bus, const sdk::ModuleChoice& choice, const ModuleLoader& loader)>;
  using IoFactory = std::function<Expected<std::shared_ptr<DigitalIoInterface>>(const sdk::ModuleChoice& choice,
                                                                                const ModuleLoader& loader)>;

  /// What becomes of an interface that nothing uses any more: it stays, with what is behind it, or it is made anew for
  /// its next use, because it is made from files that may be others by then.
  enum class Unused { Stays, IsMadeAnew };

  void add_control_interface(const std::string& name, ControlFactory factory, Unused unused = Unused::Stays);
  void add_io_interface(const std::string& name, IoFactory factory);

  /// Whether an interface of this name is built in or can be loaded. A built-in one's parameters are its buses', and
  /// are checked with them.
  [[nodiscard]] Expected<> check_control_interface(const sdk::ModuleChoice& choice, const ModuleLoader& loader) const;
  [[nodiscard]] Expected<> check_io_interface(const sdk::ModuleChoice& choice, const ModuleLoader& loader) const;

  /// The bus, brought up. A bus that runs already is shared as long as the same interface is wanted of it.
  [[nodiscard]] Expected<std::shared_ptr<ServoBus>> acquire(const std::string& bus, const sdk::ModuleChoice& choice,
                                                            const ModuleLoader& loader);
  /// Whether a bus or an interface of the device's is in use with other parameters than it has them.
  [[nodiscard]] bool runs_otherwise(const sdk::DeviceObject& device) const;
  /// What stands for a bus in virtual mode: axes and nothing behind them. The same one each time, so that a mechanism
  /// that replaces another one takes over where its drives stand.
  [[nodiscard]] std::shared_ptr<ServoBus> virtual_bus(const std::string& bus);
  [[nodiscard]] Expected<std::shared_ptr<DigitalIoInterface>> acquire_io(const sdk::ModuleChoice& choice,
                                                                         const ModuleLoader& loader);

  /// What the buses that run went through, those of I/O last, in the order of their names.
  [[nodiscard]] fieldbus::FieldbusReport reports() const;

  /// Stops what no mechanism borrows any more: drives disabled, outputs safe. What is behind it stays known.
  void stop_unused() noexcept;

 private:
  struct Bus {
    sdk::ModuleChoice choice;
    std::shared_ptr<ServoBus> bus;
    bool started = false;
  };
  struct Io {
    sdk::ModuleChoice choice;
    std::shared_ptr<DigitalIoInterface> interface;
    bool started = false;
  };

  [[nodiscard]] Expected<std::shared_ptr<DigitalControlInterface>> make_control(const std::string& bus,
                                                                                const sdk::ModuleChoice& choice,
                                                                                const ModuleLoader& loader) const;
  [[nodiscard]] Expected<std::shared_ptr<DigitalIoInterface>> make_io(const sdk::ModuleChoice& choice,
                                                                      const ModuleLoader& loader) const;

  /// A bus that nothing uses and whose interface is to be made anew is forgotten.
  void forget_outdated(const std::string& name);

  std::map<std::string, ControlFactory> control_factories_;
  std::set<std::string> made_anew_;  ///< names of interfaces
  std::map<std::string, IoFactory> io_factories_;
  std::map<std::string, Bus> buses_;
  std::map<std::string, std::shared_ptr<ServoBus>> virtual_buses_;
  std::map<std::string, Io> ios_;
};

}  // namespace rmac::gateway
