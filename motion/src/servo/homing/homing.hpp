#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/drives/shafts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"

namespace rmac {

/// Drives that look for home by themselves, turn by turn, while the other joints hold their position. Real-time safe.
class Homing {
 public:
  /// `actuators` must outlive it.
  Homing(std::span<const ServoActuator> actuators, double timeout_s, double period_s) noexcept
      : actuators_(actuators), timeout_s_(timeout_s), period_s_(period_s) {}

  enum class Progress : std::uint8_t { UnderWay, Over, Failed };

  /// Over at once where no drive looks for home.
  [[nodiscard]] Progress begin() noexcept;
  /// One cycle. `wanted`: its fall ends homing before it is through, as soon as the drives rest. Counters of drives
  /// that home jump, so their shafts are forgotten.
  [[nodiscard]] Progress step(bool wanted, Shafts& shafts, FaultSink& faults) noexcept;
  /// What a drive that homes is told, or one that has, in a turn before.
  void command(std::size_t actuator, DriveCommand& words) const noexcept;

  /// Actuators whose drives home, or have in a turn before.
  [[nodiscard]] IndexSet drives() const noexcept { return drives_; }
  /// Homings that were completed.
  [[nodiscard]] std::uint32_t completed() const noexcept { return completed_; }

 private:
  [[nodiscard]] Progress begin_turn() noexcept;
  [[nodiscard]] Progress look(std::size_t actuator, Shafts& shafts, FaultSink& faults) noexcept;
  /// Its count has not changed for a while: some drives whose homing was ended do not tell that they rest.
  [[nodiscard]] bool stands(std::size_t actuator) noexcept;
  void raise(std::size_t actuator, double bound, FaultSink& faults) const noexcept;
  [[nodiscard]] const DriveFeedback& words(std::size_t actuator) const noexcept {
    return actuators_[actuator].bus->feedback[actuators_[actuator].axis];
  }

  std::span<const ServoActuator> actuators_;
  double timeout_s_;
  double period_s_;
  IndexSet drives_ = 0;
  std::uint8_t turn_ = 0;  ///< that is under way
  bool ends_ = false;      ///< before it is through
  std::uint32_t completed_ = 0;
  std::array<int, kMaxJoints> cycles_{};  ///< that a drive has been in homing mode
  /// Where a drive was seen to stand, and for how many cycles.
  struct Standing {
    std::int32_t counts = 0;
    int cycles = 0;
  };
  std::array<Standing, kMaxJoints> standing_{};
  std::int64_t waited_cycles_ = 0;
};

}  // namespace rmac
