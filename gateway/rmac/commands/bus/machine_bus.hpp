#pragma once

#include "gateway/rmac/commands/command.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::cli {

/// Which machine's buses are meant, as options of a command.
struct MachineChoice {
  std::string machine;                ///< its name, or the path of its folder or of its device.json; empty: none
  std::filesystem::path device_tree;  ///< empty: the installation's
  std::filesystem::path drives;       ///< descriptions of those that are known; empty: the installation's
  double period_s = 0.001;
};

/// The CAN buses of a machine, in the order of their names. Fails where it has none, and with the first that its
/// device.json sets up wrongly.
[[nodiscard]] Result<std::vector<fieldbus::canopen::CanopenConfig>> canopen_buses(const MachineChoice& choice);

/// Of a machine's buses the one of this interface; the only one whatever its name is, for a bus may be looked at from
/// another computer. Null where no machine was chosen, or none of its buses fits.
[[nodiscard]] const fieldbus::canopen::CanopenConfig* bus_of_interface(
    const std::vector<fieldbus::canopen::CanopenConfig>& buses, const std::string& interface);

/// --machine and --device-tree.
void add_machine_options(Command& command, MachineChoice& choice);

}  // namespace rmac::cli
