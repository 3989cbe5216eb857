#pragma once

#include "gateway/reconfiguration/mechanism_slot.hpp"

namespace rmac::gateway {

/// Puts the mechanism in force over another interface to its drives. Two interfaces cannot run one bus, so this is no
/// swap between two cycles: the drives come down with the old one, and up with the new one or, when that fails, with
/// the old one again. Gateway thread.
class InterfaceChange {
 public:
  InterfaceChange(MechanismSlot& slot, const Assembler& assembler, BusRegistry& registry)
      : slot_(slot), assembler_(assembler), registry_(registry) {}

  /// Whether the machine comes down for this: the mechanism in force has drives, and `device` another interface to
  /// them.
  [[nodiscard]] bool needed(const sdk::DeviceObject& device, const MechanismSource& source) const;
  /// At rest.
  [[nodiscard]] Expected<> put_in(const sdk::DeviceObject& device, const MechanismSource& source);

 private:
  [[nodiscard]] Expected<> bring_up(const sdk::DeviceObject& device, const MechanismSource& source);

  MechanismSlot& slot_;
  const Assembler& assembler_;
  BusRegistry& registry_;
};

}  // namespace rmac::gateway
