#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// A mechanism as it is being configured: plain data that the editors work on. `function` is what an error names: the
/// call that could not be carried out. Gateway thread only.
struct Draft {
  /// How far a draft goes beyond what is in force.
  enum class Extent : std::uint8_t {
    Loops,          ///< servo laws of joints and what belongs to them; none comes or goes, and no joint leaves the plan
    Configuration,  ///< the same mechanism, with anything changed
    Mechanism,      ///< another one
  };

  sdk::DeviceObject device;
  /// What is known of parts that are not there, or not yet: of joints, until they are applied, what no setter says.
  std::vector<sdk::Joint> described;
  std::vector<sdk::Spindle> described_spindles;
  std::vector<sdk::Actuator> described_actuators;
  bool begun = false;
  Extent extent = Extent::Loops;

  /// Starts a new one: of its joints it holds what no setter sets, and of its modules none.
  void begin(const sdk::DeviceObject& from);
  /// Goes on from what is in force, or from nothing.
  void restart(const sdk::DeviceObject* in_force);
  /// It is in force now: what comes and goes from here on is what it was.
  void applied();
  /// The device, for a change that is more than one of loops.
  [[nodiscard]] sdk::DeviceObject& edit() noexcept;
  /// Joints count first, held joints follow.
  [[nodiscard]] Expected<sdk::Joint*> joint(int number, const char* function);
  /// Likewise, for a change that is more than one of loops.
  [[nodiscard]] Expected<sdk::Joint*> edit_joint(int number, const char* function);
  [[nodiscard]] Expected<sdk::Spindle*> edit_spindle(int number, const char* function);
};

/// Puts a module in its place; one without a name is refused.
[[nodiscard]] Expected<> choose_module(const char* function, const sdk::ModuleChoice& module,
                                       sdk::ModuleChoice& target);
/// Refuses a gain of a servo law that no law could take.
[[nodiscard]] Expected<> check_gains(const char* function, std::span<const double> gains);

}  // namespace rmac::gateway
