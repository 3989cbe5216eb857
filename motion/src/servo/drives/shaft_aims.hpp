#pragma once

#include <array>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/setpoint/recent_way.hpp"

namespace rmac {

/// Where the drives are sent that follow a position or a velocity themselves: shaft angles, in rad. Real-time safe.
class ShaftAims {
 public:
  /// `actuators` must outlive it. `delays`: so many cycles before this one was each where it tells in it.
  ShaftAims(std::span<const ServoActuator> actuators, const Wiring::Delays& delays, double period_s) noexcept;

  /// One cycle: `wanted` shaft angles of all actuators; those in `followed` are under control and go there. Where there
  /// is no number for one of these, that is a fault, and none is sent anywhere.
  void step(std::span<const double> wanted, IndexSet followed, FaultSink& faults) noexcept;
  [[nodiscard]] bool sends(std::size_t actuator) const noexcept { return has(aimed_, actuator); }
  [[nodiscard]] double operator[](std::size_t actuator) const noexcept { return aim_[actuator]; }
  /// The drive's setpoint, as its mode takes it, and beside a position how fast that goes: on the way to it within this
  /// cycle, so that all of these velocities add up to the position; `measured_rad`: where it says that its shaft is.
  void command(std::size_t actuator, double measured_rad, DriveCommand& words) const noexcept;

 private:
  std::span<const ServoActuator> actuators_;
  double period_s_;
  std::array<double, kMaxJoints> aim_{}, aim_before_{};
  std::array<RecentWay, kMaxJoints> ways_;  ///< of the aims, as long ago as the answers are
  IndexSet aimed_ = 0;                      ///< sent there in the last cycle
};

}  // namespace rmac
