#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/mechanism/assembler.hpp"
#include "gateway/reconfiguration/machine_power.hpp"
#include "gateway/reconfiguration/mechanism_users.hpp"
#include "gateway/reconfiguration/servo_requests.hpp"

namespace rmac::gateway {

/// The place of the mechanism in force, and the steps that all changes of it are made of: servo thread, motion
/// supervisor, drives' power, buses and users learn of it in the order that each needs. Gateway thread.
class MechanismSlot {
 public:
  MechanismSlot(MotionSupervisor& supervisor, ServoRequests& servo, const Assembler& assembler, BusRegistry& registry,
                MechanismUsers& users);

  [[nodiscard]] const std::shared_ptr<Mechanism>& in_force() const noexcept { return in_force_; }
  /// The mechanism that a fault of this generation is of; nullptr when it is gone.
  [[nodiscard]] const Mechanism* of_generation(std::uint64_t generation) const noexcept {
    return generation == generation_ ? in_force_.get() : nullptr;
  }
  /// The folder with the modules of the mechanism in force.
  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  void set_folder(std::string folder) { folder_ = std::move(folder); }
  /// Where the servo loop holds its joints, held ones included: mm or degrees.
  [[nodiscard]] std::vector<double> standing() const;

  /// Refuses a change, which `what` names, while the machine is faulted.
  [[nodiscard]] Expected<> require_sound(const char* what);
  /// Refuses it while the machine moves or has moves to do, too.
  [[nodiscard]] Expected<> require_rest(const char* what);

  /// Puts a mechanism in, at rest and as it is powered. `keep_running`: the cycle keeps its state.
  [[nodiscard]] Expected<> put_in(std::shared_ptr<Mechanism> next, bool keep_running);
  /// Enables the drives.
  [[nodiscard]] Expected<> power_on() { return power_.on(in_force_.get()); }
  /// The same where the drives were nobody's. One that is in fault is in it since before, as after the death of the
  /// master that had it: it is reset, once; one that stays in it has the cause still there.
  [[nodiscard]] Expected<> power_on_anew();
  [[nodiscard]] Expected<> clear_fault() { return power_.clear_fault(in_force_.get()); }
  /// Takes the power off the mechanism in force, and the servo thread away from it.
  [[nodiscard]] Expected<> switch_off();
  /// Has users forget the mechanism, and buses stop that nobody else borrows.
  void drop(bool fresh);
  /// Takes the mechanism out for good.
  [[nodiscard]] Expected<> unload();
  /// Forgets the mechanism when the servo thread has ended.
  void abandon();

  /// What was in force before a change, and is to be again if that fails.
  struct Predecessor {
    std::shared_ptr<Mechanism> mechanism;  ///< kept so that its users may use it until they are told; may be null
    sdk::DeviceObject device;
    MechanismSource source;
    std::string over;  ///< for people: " over" the interface to its drives, where that is what was exchanged
  };
  [[nodiscard]] std::optional<Predecessor> predecessor() const;
  /// After a change that worked: users and listeners are told, and what was there before goes.
  void settle(std::optional<Predecessor> gone, bool fresh, const std::string& message);
  /// After a change that failed: what was there before is in force again. The error says why it failed, and what is in
  /// force now.
  [[nodiscard]] Error undo(std::optional<Predecessor> before, const Error& why);
  /// Tells the listeners.
  void report(const std::string& message);

 private:
  [[nodiscard]] Expected<> put_back(const Predecessor& before);
  /// Ends a fault whose cause went with the mechanism that had it.
  void leave_fault();
  /// A spindle that turns faster than it may now slows down, and feed does not wait for the speed that it had.
  void bound_spindles();

  MotionSupervisor& supervisor_;
  ServoRequests& servo_;
  const Assembler& assembler_;
  BusRegistry& registry_;
  MechanismUsers& users_;
  MachinePower power_;
  std::shared_ptr<Mechanism> in_force_;
  std::string folder_;
  std::uint64_t generation_ = 0;  ///< counts mechanisms that were put in or taken out
};

}  // namespace rmac::gateway
