#pragma once

#include <cstddef>
#include <vector>

#include "gateway/reconfiguration/mechanism_slot.hpp"

namespace rmac::gateway {

/// Exchanges servo laws, gains and control methods of joints of the mechanism in force, and nothing else: the servo
/// thread does it between two cycles, in motion too, and all that is planned goes on. Gateway thread.
class LoopChange {
 public:
  LoopChange(MechanismSlot& slot, ServoRequests& servo, const Assembler& assembler, MechanismUsers& users)
      : slot_(slot), servo_(servo), assembler_(assembler), users_(users) {}

  /// The joints whose law, gains or control method `device` has otherwise than the mechanism in force, by number.
  [[nodiscard]] std::vector<std::size_t> joints(const sdk::DeviceObject& device) const;
  /// Whether one of them gets another control method.
  [[nodiscard]] bool changes_method(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints) const;
  /// Refuses it for a machine that is faulted, and for a device object that is unsound.
  [[nodiscard]] Expected<> check(const sdk::DeviceObject& device);
  [[nodiscard]] Expected<> exchange(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints);

 private:
  /// What goes to the servo thread, and what is known of it then.
  struct Loops {
    std::vector<SwapRequest::Law> laws;
    std::vector<SwapRequest::Method> methods;
    std::vector<ModuleInUse> modules;
    std::vector<std::string> names;  ///< those of the joints
  };
  [[nodiscard]] Expected<Loops> load(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints) const;
  [[nodiscard]] Expected<> hand_over(const sdk::DeviceObject& device, Loops& loops);
  void note(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints, const Loops& loops);

  MechanismSlot& slot_;
  ServoRequests& servo_;
  const Assembler& assembler_;
  MechanismUsers& users_;
};

}  // namespace rmac::gateway
