#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/verification/checks/check.hpp"
#include "gateway/verifier/worker.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_report.hpp"

namespace rmac::verifier {

/// All modules of a mechanism together, its servo loops on the axis models of its buses, cycled by hand. Its inputs and
/// outputs are left out: their device may not be here.
class MachineRig {
 public:
  static constexpr double kPeriod_s = 0.001;

  /// `virtual_mode`: no loop is closed, and setpoints are where the joints are.
  [[nodiscard]] static tl::expected<std::unique_ptr<MachineRig>, CounterExample> assemble(
      const Task& task, const sdk::DeviceObject& device, bool virtual_mode, Watch& watch);

  /// Has the drives come up, and hold where they stand.
  Checked power_up();
  /// One cycle of `command`.
  Checked cycle();
  [[nodiscard]] tl::unexpected<CounterExample> fault(const char* check, std::string what) const;

  [[nodiscard]] gateway::Mechanism& mechanism() noexcept { return *mechanism_; }
  [[nodiscard]] const gateway::Mechanism& mechanism() const noexcept { return *mechanism_; }
  [[nodiscard]] const ServoReport& report() const noexcept { return report_; }

  ServoCommand command;

 private:
  MachineRig(Watch& watch) : watch_(watch) {}
  void hold_still();

  Watch& watch_;
  gateway::BusRegistry registry_;
  std::shared_ptr<gateway::Mechanism> mechanism_;
  ServoReport report_;
  std::int64_t cycles_ = 0;
};

}  // namespace rmac::verifier
