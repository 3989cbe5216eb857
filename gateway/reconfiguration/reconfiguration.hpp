#pragma once

#include <functional>
#include <string>

#include "gateway/reconfiguration/interface_change.hpp"
#include "gateway/reconfiguration/learning.hpp"
#include "gateway/reconfiguration/loop_change.hpp"
#include "gateway/reconfiguration/mechanism_change.hpp"
#include "gateway/reconfiguration/mechanism_slot.hpp"

namespace rmac::gateway {

/// Changes the mechanism in force: decides which way a change takes, and takes it. Nothing of it happens on the servo
/// thread but the exchange itself. Gateway thread.
class Reconfiguration {
 public:
  /// What it works on, all of which outlives it.
  struct Parts {
    ServoLink& link;
    MotionSupervisor& supervisor;
    const Assembler& assembler;
    BusRegistry& registry;
    ToolRack& rack;
    MechanismUsers& users;
  };
  /// `meanwhile`: see `ServoRequests`. `simulated`: what happens to tools leaves no trace.
  Reconfiguration(const Parts& parts, std::function<void()> meanwhile, bool simulated);

  /// The mechanism in force, or nullptr.
  [[nodiscard]] const Mechanism* mechanism() const noexcept { return slot_.in_force().get(); }
  [[nodiscard]] const sdk::DeviceObject* device() const noexcept {
    return mechanism() == nullptr ? nullptr : &mechanism()->device;
  }
  /// The mechanism that a fault of this generation is of; nullptr when it is gone.
  [[nodiscard]] const Mechanism* of_generation(std::uint64_t generation) const noexcept {
    return slot_.of_generation(generation);
  }

  /// Puts in what a device object describes. `fresh`: another mechanism, which begins anew.
  [[nodiscard]] Expected<> put_in(const sdk::DeviceObject& device, const MechanismSource& source, bool fresh);
  /// The same for a device object that is that of the mechanism in force but for joints' loops: in motion, where that
  /// can be.
  [[nodiscard]] Expected<> change_loops(const sdk::DeviceObject& device, const MechanismSource& source);
  /// Brings the machine back after a fault whose cause is gone; the drives are enabled then.
  [[nodiscard]] Expected<> reset();
  /// Takes the mechanism out, at rest or faulted.
  [[nodiscard]] Expected<> unload();
  /// What was learned of a program; ends with a change of the mechanism.
  [[nodiscard]] LearningPort& learning() noexcept { return learning_; }
  /// Waits for a stop that was ordered, then unloads; whatever goes wrong, it returns.
  void come_to_rest();
  /// Forgets the mechanism when the servo thread has ended.
  void abandon() { slot_.abandon(); }

 private:
  MotionSupervisor& supervisor_;
  MechanismUsers& users_;
  ServoRequests servo_;
  MechanismSlot slot_;
  MechanismChange mechanism_change_;
  InterfaceChange interface_change_;
  LoopChange loop_change_;
  Learning learning_;
};

}  // namespace rmac::gateway
